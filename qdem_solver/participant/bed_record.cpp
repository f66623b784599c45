#include "qdem_solver/participant/bed_record.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace qdem {

BedRecord::BedRecord(TrackBed& bed, EnergyWatch& energy, RecordSettings settings)
    : bed_(bed), energy_(energy), settings_(std::move(settings)), start_positions_(bed.state().x) {
  const auto& folder = settings_.folder;
  const auto& attributes = settings_.attributes;
  if (settings_.output_interval > 0) {
    fields_.emplace(folder + "/qdem.h5", bed.model(), bed.state(), attributes, bed.state().ledger.open);
    if (bed.settings().contact_output) contacts_.emplace(folder + "/contacts.h5", attributes);
  }
  const SensorsSettings& sensors = bed.settings().sensors;
  if (!sensors.list.empty()) sensors_.emplace(folder + "/sensors.h5", sensors, bed.model(), bed.state(), attributes);
  look(0.0);
}

BedRecord::BedRecord(TrackBed& bed, EnergyWatch& energy, RecordSettings settings, proto::StateArchive& saved)
    : bed_(bed), energy_(energy), settings_(std::move(settings)) {
  const auto& folder = settings_.folder;
  const auto& attributes = settings_.attributes;
  exchange_counts(saved);
  if (settings_.output_interval > 0) {
    fields_.emplace(FieldsFile::resume(folder + "/qdem.h5", bed.model(), start(), attributes, n_outputs_,
                                       bed.state().ledger.open));
    if (bed.settings().contact_output)
      contacts_.emplace(ContactsFile::resume(folder + "/contacts.h5", attributes, n_contact_rows_));
  }
  const SensorsSettings& sensors = bed.settings().sensors;
  if (!sensors.list.empty())
    sensors_.emplace(folder + "/sensors.h5", sensors, bed.model(), start(), attributes, saved);
}

State BedRecord::start() const {
  State state;
  state.x = start_positions_;
  return state;
}

void BedRecord::exchange_counts(proto::StateArchive& archive) {
  archive("record/start_positions", start_positions_);
  archive("record/outputs", n_outputs_);
  archive("record/contact_rows", n_contact_rows_);
  archive("record/last_energy_look", last_energy_look_);
}

void BedRecord::exchange(proto::StateArchive& archive) {
  exchange_counts(archive);
  if (sensors_) sensors_->exchange(archive);
}

double BedRecord::next_time() const {
  double next = std::numeric_limits<double>::infinity();
  if (fields_) next = static_cast<double>(n_outputs_) * settings_.output_interval;
  if (sensors_) next = std::min(next, sensors_->next_time());
  return next;
}

bool BedRecord::fields_are_due(double time) const {
  return fields_ && time >= static_cast<double>(n_outputs_) * settings_.output_interval * (1 - 1e-9);
}

void BedRecord::look(double time) {
  const State& state = bed_.state();
  if (sensors_) sensors_->look(time, state, bed_.engine().contacts());
  const bool due = fields_are_due(time);
  if (!due && state.step - last_energy_look_ < steps_per_energy_look) return;
  last_energy_look_ = state.step;
  const EnergyBalance& balance = energy_.look(bed_.engine(), state);
  if (!due) return;
  fields_->write(time, state, bed_.engine(), balance);
  if (contacts_) {
    contacts_->write(time, state, bed_.engine().contacts());
    n_contact_rows_ = contacts_->n_rows();
  }
  ++n_outputs_;
}

void BedRecord::synchronise() {
  if (fields_) fields_->synchronise();
  if (contacts_) contacts_->synchronise();
  if (sensors_) sensors_->synchronise();
}

void BedRecord::close() {
  if (fields_) fields_->close();
  if (contacts_) contacts_->close();
  if (sensors_) sensors_->close();
}

}  // namespace qdem
