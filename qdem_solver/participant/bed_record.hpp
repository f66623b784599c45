// What a run of the bed writes, and its look at the energy ledger.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/result/state_archive.hpp"
#include "qdem_solver/output/contacts_file.hpp"
#include "qdem_solver/output/fields_file.hpp"
#include "qdem_solver/participant/energy_watch.hpp"
#include "qdem_solver/participant/track_bed.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"

namespace qdem {

/// Where and how often.
struct RecordSettings {
  std::string folder;
  double output_interval = 0.0;  ///< of qdem.h5 and contacts.h5; 0: neither [s]
  proto::Attributes attributes;  ///< of every file
};

/// qdem.h5, contacts.h5 where the case wants it, and sensors.h5 where it has sensors, each written when it is due.
/// The state at the construction, or that of the run that is resumed, is what displacements count from.
class BedRecord {
 public:
  /// Creates the files and writes the state of time 0. `bed` and `energy` must outlive the object.
  /// Throws proto::Error (cannot_create, io_error; bad_data for a sensor without anything to measure).
  BedRecord(TrackBed& bed, EnergyWatch& energy, RecordSettings settings);
  /// Goes on with the files of an earlier run from what its exchange() saved.
  BedRecord(TrackBed& bed, EnergyWatch& energy, RecordSettings settings, proto::StateArchive& saved);

  /// When something is due next [s]; infinite if nothing will be.
  double next_time() const;
  /// Writes what is due at `time` [s], the state of the bed. Looks at the ledger with every output, and after
  /// steps_per_energy_look steps without one. Throws proto::Error (io_error; numerics from the ledger).
  void look(double time);

  /// How far the files have come, and what displacements count from.
  void exchange(proto::StateArchive& archive);
  /// What was written is safe against a loss of power.
  void synchronise();
  void close();

 private:
  void exchange_counts(proto::StateArchive& archive);
  bool fields_are_due(double time) const;
  State start() const;

  TrackBed& bed_;
  EnergyWatch& energy_;
  RecordSettings settings_;
  std::vector<double> start_positions_;  ///< of all particles at time 0, laid out like State::x
  std::uint64_t n_outputs_ = 0, n_contact_rows_ = 0;
  std::int64_t last_energy_look_ = 0;  ///< State::step
  std::optional<FieldsFile> fields_;
  std::optional<ContactsFile> contacts_;
  std::optional<SensorFile> sensors_;
};

}  // namespace qdem
