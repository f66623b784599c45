#include "fem_solver/output/patch_record.hpp"

#include "fem_solver/output/fem_record.hpp"
#include "proto/result/provenance.hpp"

namespace fem {
namespace {

std::vector<proto::Column> columns(const PatchGrid& grid) {
  const std::vector<std::size_t> shape{static_cast<std::size_t>(grid.n_y), static_cast<std::size_t>(grid.n_x)};
  return {{"time", "s", "end of the window", {}},
          {"position", "m", "x of the grid's centre", {}},
          {"element_x", "m", "centres along the rail from the grid's centre", {shape[1]}},
          {"element_y", "m", "centres across the rail from the grid's centre", {shape[0]}},
          {"pressure", "Pa", "", shape},
          {"shear_x", "Pa", "on the wheel, along", shape},
          {"shear_y", "Pa", "on the wheel, across", shape},
          {"slip_x", "1", "micro-slip of the wheel over the rail per distance rolled", shape},
          {"slip_y", "1", "micro-slip of the wheel over the rail per distance rolled", shape},
          {"zone", "1", "0 open, 1 stick, 2 slip", shape}};
}

}  // namespace

PatchRecord::PatchRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
                         const PatchContact& contact, double window, proto::StateArchive* saved)
    : contact_(contact),
      window_s_(window),
      interval_windows_(
          windows_per_output(contact.settings().record_interval, window, "wheel.patch.record_interval_s")) {
  if (saved != nullptr) exchange(*saved);
  if (interval_windows_ == 0) return;
  const std::string path = directory + "/patch.h5";
  const auto attributes = proto::provenance(program, file.name(), file.hash(), file.text());
  const auto all = columns(contact.grid());
  file_ = std::make_unique<proto::TimeSeriesFile>(saved != nullptr
                                                      ? proto::TimeSeriesFile::resume(path, n_rows_, all, attributes)
                                                      : proto::TimeSeriesFile::create(path, all, attributes));
}

void PatchRecord::synchronise() {
  if (file_) file_->synchronise();
}

void PatchRecord::window(const RunState& state) {
  if (!file_ || state.windows % interval_windows_ != 0) return;
  const PatchGrid& grid = contact_.grid();
  const auto put = [this](const char* name, const PatchField& field) {
    file_->put(name, std::vector<double>(field.data(), field.data() + field.size()));
  };
  PatchField zone = grid.zeros(), x(grid.n_x, 1), y(grid.n_y, 1);
  const auto zones_now = contact_.zones(state.patch);
  for (Eigen::Index k = 0; k < zone.size(); ++k) zone(k) = static_cast<double>(zones_now[static_cast<std::size_t>(k)]);
  for (int i = 0; i < grid.n_x; ++i) x(i) = grid.x(i);
  for (int j = 0; j < grid.n_y; ++j) y(j) = grid.y(j);
  file_->put("time", static_cast<double>(state.windows) * window_s_);
  file_->put("position", state.wheel_position);
  put("element_x", x), put("element_y", y);
  put("pressure", state.patch.pressure);
  put("shear_x", state.patch.traction.x), put("shear_y", state.patch.traction.y);
  put("slip_x", state.patch.slip.x), put("slip_y", state.patch.slip.y);
  put("zone", zone);
  file_->end_row();
  ++n_rows_;
}

void PatchRecord::close() {
  if (file_) file_->close();
}

}  // namespace fem
