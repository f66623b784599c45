#include "qdem_solver/output/exchange.hpp"

namespace qdem {
namespace {

void exchange_keys(proto::StateArchive& archive, const std::string& name, std::vector<ContactKey>& keys) {
  std::vector<int> list;
  for (const ContactKey& key : keys) list.insert(list.end(), {key.body_a, key.body_b, key.feature_a, key.feature_b});
  archive(name, list);
  archive.expect_length(name, list.size() % 4, 0);
  keys.clear();
  for (std::size_t i = 0; i < list.size(); i += 4) keys.push_back({list[i], list[i + 1], list[i + 2], list[i + 3]});
}

void exchange(proto::StateArchive& archive, const std::string& prefix, StoredEnergy& energy) {
  archive(prefix + "kinetic", energy.kinetic);
  archive(prefix + "strain", energy.strain);
  archive(prefix + "contact", energy.contact);
  archive(prefix + "gravity", energy.gravity);
  archive(prefix + "boundary", energy.boundary);
}

void exchange(proto::StateArchive& archive, const std::string& prefix, EnergyLedger& ledger) {
  archive(prefix + "open", ledger.open);
  exchange(archive, prefix + "start/", ledger.start);
  archive(prefix + "first_step", ledger.first_step);
  archive(prefix + "work", ledger.work);
  archive(prefix + "largest_work", ledger.largest_work);
  archive(prefix + "contact_dashpots", ledger.contact_dashpots);
  archive(prefix + "friction", ledger.friction);
  archive(prefix + "viscous", ledger.viscous);
  archive(prefix + "viscous_time", ledger.viscous_time);
  archive(prefix + "viscous_power", ledger.viscous_power);
  archive(prefix + "radiated", ledger.radiated);
  archive(prefix + "radiated_power", ledger.radiated_power);
  archive(prefix + "dashpot_power", ledger.contact_power.dashpot);
  archive(prefix + "friction_power", ledger.contact_power.friction);
}

/// Six values of every load.
void exchange(proto::StateArchive& archive, const std::string& name, std::vector<LoadState>& loads) {
  std::vector<double> list;
  for (const LoadState& load : loads) {
    list.insert(list.end(), {load.origin, load.path, load.force, load.position, load.velocity, load.acceleration});
  }
  archive(name, list);
  archive.expect_length(name, list.size() % 6, 0);
  loads.clear();
  for (std::size_t i = 0; i < list.size(); i += 6) {
    loads.push_back({list[i], list[i + 1], list[i + 2], list[i + 3], list[i + 4], list[i + 5]});
  }
}

}  // namespace

void exchange(proto::StateArchive& archive, const std::string& prefix, ContactState& contact) {
  exchange_keys(archive, prefix + "keys", contact.keys);
  archive(prefix + "triangle_offsets", contact.triangle_offsets);
  archive(prefix + "triangles", contact.triangles);
  archive(prefix + "slip", contact.slip);
  archive(prefix + "roll", contact.roll);
  archive(prefix + "travel", contact.travel);
  archive(prefix + "rebuilds", contact.rebuilds);
  archive(prefix + "rebuild_time", contact.rebuild_time);
  archive(prefix + "list_id", contact.list_id);
}

void exchange(proto::StateArchive& archive, const std::string& prefix, State& state) {
  const std::size_t n = state.x.size();
  state.resident.reset();  // a device takes the values of the host anew
  archive(prefix + "step", state.step);
  archive(prefix + "time", state.time);
  archive(prefix + "x", state.x);
  archive(prefix + "v", state.v);
  archive(prefix + "a", state.a);
  for (const auto* values : {&state.x, &state.v, &state.a})
    archive.expect_length(prefix + "x, v, a", values->size(), n);
  archive(prefix + "pad_force", state.pad_force);
  exchange(archive, prefix + "contact/", state.contact);
  exchange(archive, prefix + "loads", state.loads);
  exchange(archive, prefix + "ledger/", state.ledger);
}

}  // namespace qdem
