// The messages of the coupling protocol as plain values. proto/README.md says who sends which when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace proto {

enum class Phase { initialise, march };

/// How the implicit side is loaded at the interface: by its own pad law against a predicted sleeper (Robin), or by a
/// given mean force.
enum class LoadMode { robin, prescribed_force };

/// Names of the interface fields; each holds one value per seat, cell and seat axis.
namespace field {
inline constexpr const char* rail_displacement = "rail_displacement";              ///< u at the window's end [m]
inline constexpr const char* rail_displacement_begin = "rail_displacement_begin";  ///< u at the window's begin [m]
inline constexpr const char* rail_velocity = "rail_velocity";                      ///< u' at the window's end [m/s]
inline constexpr const char* rail_velocity_begin = "rail_velocity_begin";          ///< u' at the window's begin [m/s]
inline constexpr const char* sleeper_displacement = "sleeper_displacement";        ///< x at the window's end [m]
inline constexpr const char* sleeper_velocity = "sleeper_velocity";                ///< x' at the window's end [m/s]
inline constexpr const char* sleeper_mean_displacement = "sleeper_mean_displacement";  ///< predicted window mean of x [m]
inline constexpr const char* sleeper_mean_velocity = "sleeper_mean_velocity";          ///< predicted window mean of x' [m/s]
inline constexpr const char* path_velocity_begin = "path_velocity_begin";  ///< slope of the rail's cubic path [m/s]
inline constexpr const char* path_velocity = "path_velocity";              ///< the same at the window's end [m/s]
inline constexpr const char* joint_force_begin = "joint_force_begin";      ///< rigid joint: force on the sleeper at t_n [N]
inline constexpr const char* joint_force = "joint_force";                  ///< the same at t_n+1, linear between [N]
inline constexpr const char* impulse = "impulse";            ///< of the pad force on the sleeper over the window [N s]
inline constexpr const char* pad_work = "pad_work";          ///< sum over sub-steps of f . du, per value [J]
inline constexpr const char* force_carry = "force_carry";    ///< to subtract from the Robin force [N]
inline constexpr const char* force_mean = "force_mean";      ///< prescribed window mean of the force on the sleeper [N]
inline constexpr const char* force_robin = "force_robin";    ///< the FEM's pad force before the carry [N]
inline constexpr const char* force_used = "force_used";      ///< the force whose reaction loaded the rail [N]
}  // namespace field

struct Field {
  std::string name;
  std::vector<double> values;
};

/// Whether a field of the rail's side runs over the pad's cells even if that side has points of its own: what its pad
/// needs and gives in the mode robin.
bool belongs_to_pad(const std::string& name, LoadMode mode);

/// Fields of one message, by name.
class FieldSet {
 public:
  void set(const std::string& name, std::vector<double> values);
  bool has(const std::string& name) const;
  /// Throws proto::Error (protocol) naming the field that is missing.
  const std::vector<double>& get(const std::string& name) const;
  const std::vector<Field>& all() const { return fields_; }

 private:
  std::vector<Field> fields_;
};

struct Fact {
  std::string key;                 ///< e.g. "bed.porosity"; becomes that path in summary.json
  std::optional<double> number;
  std::string text;                ///< used when there is no number
};

struct Capabilities {
  bool robin = false, rollback = false, save_restore = false, initialise = false;
};

struct Hello {
  std::string name;
  std::uint32_t protocol_major = 0, protocol_minor = 0;
  std::uint64_t schema_hash = 0, case_hash = 0;
  std::string session_token, build_id;
  Capabilities capabilities;
};
struct Welcome { std::uint64_t session = 0; double heartbeat_s = 1.0; };
struct Reject { std::string reason; };

struct FieldSpec { std::string name, unit; std::uint32_t components = 3; bool outgoing = false; };

/// A participant's own account of its operator from nodes to the cells of one seat, and of its transpose.
struct SeatRegistration {
  std::string name;
  std::vector<double> points;            ///< [3 n] global frame [m]
  std::vector<double> weights;           ///< [n]
  std::vector<double> rigid_response;    ///< [6][3 n] cell values in seat axes under translation x,y,z [m] and rotation about x,y,z through the seat origin [rad]
  std::vector<double> force_resultants;  ///< [3 n][6] force [N] and moment about the seat origin [N m], global frame, of a unit value
  std::vector<double> stiffness, damping, preload;  ///< [3 n], only from the side that owns the pad
  std::vector<bool> tension_cutoff;                 ///< [3 n]
  bool own_points = false;                          ///< not the case's cells: the coupler maps
};
struct Interface { std::vector<FieldSpec> fields; std::vector<SeatRegistration> seats; };

struct Configure {
  double window_s = 0.0;
  std::uint64_t windows = 0;
  LoadMode mode = LoadMode::robin;
  std::string output_directory;
  std::vector<double> stiffness, damping, preload;  ///< pad per interface value, as the pad's owner registered it
  std::vector<bool> tension_cutoff;
  /// Per seat [3 cells][3 points] in seat axes: motion of the pad's cells from that of the receiver's own points; empty
  /// for one that registered the cells.
  std::vector<double> pad_map = {};
};
struct Configured {
  std::optional<double> largest_step_s;  ///< of an explicit solver [s]
  std::vector<Fact> facts;
  std::optional<double> largest_initialise_step_s = {};  ///< of the initialise phase, if it is another [s]
};

struct Start {};
struct Advance {
  Phase phase = Phase::march;
  std::int64_t window = 0;
  std::uint32_t iteration = 0;
  double window_s = 0.0;
  std::uint32_t sub_cycles = 1;
  FieldSet data;
};
struct Result {
  Phase phase = Phase::march;
  std::int64_t window = 0;     ///< -1 for the initial values that answer Start
  std::uint32_t iteration = 0;
  double compute_s = 0.0;
  FieldSet data;
  std::optional<double> residual = {};        ///< out-of-balance force over force scale [-]; initialise phase only
  std::optional<double> largest_step_s = {};  ///< of the next window, if not Configured's; march only [s]
};
struct Commit { std::int64_t window = 0; };
struct Rollback { std::int64_t window = 0; };
struct Save { std::int64_t window = 0; std::string path; };
struct Saved { std::int64_t window = 0; std::uint64_t hash = 0; };
struct Restore { std::int64_t window = 0; std::string path; std::uint64_t hash = 0; };
struct Restored { std::int64_t window = 0; };
struct Heartbeat { std::int64_t window = 0; std::uint64_t progress = 0; };
struct Fault { int code = 0; std::string text; };
struct Finish {};
struct Bye { std::vector<Fact> facts; };

using Body = std::variant<Hello, Welcome, Reject, Interface, Configure, Configured, Start, Advance, Result, Commit,
                          Rollback, Save, Saved, Restore, Restored, Heartbeat, Fault, Finish, Bye>;

struct Message {
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::uint64_t in_reply_to = 0;
  Body body;
};

/// The message's name as in proto/README.md, e.g. "Advance".
const char* name_of(const Body& body);

}  // namespace proto
