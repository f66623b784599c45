// Where a run can go on from: sets of files that belong together.
//
// Two slots, `checkpoint/A` and `checkpoint/B` in the run's folder, are written in turn. A set is what qdem, fem and
// the coupler saved after the same window; its `manifest.json`, written last, makes it count.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace coupler {

/// What a set says of itself.
struct Manifest {
  std::int64_t window = -1;  ///< the last one committed
  double window_s = 0.0;
  std::string case_path;  ///< absolute; the case's text is the run folder's case.toml
  std::uint64_t case_hash = 0;
  std::string version, source;                  ///< of the coupler
  std::map<std::string, std::string> builds;    ///< of the participants, by name, as their Hello said
  std::map<std::string, std::uint64_t> hashes;  ///< XXH3-64 of each file, by the name of who saved it
};

/// A set on the disk.
struct Checkpoint {
  std::string folder;
  Manifest manifest;
  /// Path of what `name` saved.
  std::string file(const std::string& name) const { return folder + "/" + name + ".h5"; }
};

/// The two slots of one run.
class CheckpointSlots {
 public:
  explicit CheckpointSlots(const std::string& run_folder) : folder_(run_folder + "/checkpoint") {}

  /// Makes room for the next set in the slot that holds no set or the older one, which is void from here on.
  /// Returns the set to be filled. Throws proto::Error (cannot_create).
  Checkpoint begin() const;

  /// The set counts from here on. Throws proto::Error (io_error).
  static void complete(const Checkpoint& set);

  /// The newest set of which every file is there and has its hash. What is wrong with a newer one is added to
  /// `problems`.
  std::optional<Checkpoint> newest(std::vector<std::string>& problems) const;

  /// Makes sets of later windows void: the run goes on from `set` on another way.
  void forget_later(const Checkpoint& set) const;

 private:
  std::optional<Checkpoint> read(const std::string& slot, std::vector<std::string>& problems) const;
  std::vector<Checkpoint> all(std::vector<std::string>& problems) const;

  std::string folder_;
};

}  // namespace coupler
