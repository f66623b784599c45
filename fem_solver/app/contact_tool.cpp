#include "fem_solver/app/contact_tool.hpp"

#include <cstdio>

#include "fem_solver/contact/contact_analysis.hpp"
#include "proto/error.hpp"
#include "proto/result/array_file.hpp"
#include "proto/result/provenance.hpp"

namespace fem {
namespace {

std::vector<double> flat(const PatchField& field) {
  return {field.data(), field.data() + field.size()};
}

void print_patch(const ContactCase& input, const ContactResult& result) {
  const PatchEllipse& e = result.ellipse;
  std::printf("grid %d x %d elements of %.4f x %.4f mm; normal force %.3f kN\n", result.grid.n_x, result.grid.n_y,
              result.grid.dx * 1e3, result.grid.dy * 1e3, input.normal_force * 1e-3);
  std::printf("patch %.3f mm2, semi-axes %.4f mm along and %.4f mm across, p0 %.2f MPa, approach %.3f um\n",
              result.area * 1e6, e.semi_axis_x * 1e3, e.semi_axis_y * 1e3, e.peak_pressure * 1e-6,
              result.normal.approach * 1e6);
  if (input.hertz)
    std::printf("Hertz: semi-axes %.4f mm along and %.4f mm across, p0 %.2f MPa\n", input.hertz->semi_axis_x * 1e3,
                input.hertz->semi_axis_y * 1e3, input.hertz->peak_pressure * 1e-6);
  if (!input.geometry.profiles.empty())
    std::printf("contact at y = %.4f mm of the rail's profile\n", result.gap.centre_y * 1e3);
}

void print_friction(const ContactCase& input, const ContactResult& result) {
  const double full = input.friction * input.normal_force;
  const ShearResultant& f = result.point.force;
  std::printf("on the wheel: %.2f N along, %.2f N across, %.3f N m about the normal; mu N %.2f N; %.1f %% sticks\n",
              f.longitudinal, f.lateral, f.moment, full, result.point.stick_share * 100);
  std::printf("stick o, slip x; rolling to the right:\n");
  for (int j = result.grid.n_y - 1; j >= 0; --j) {
    for (int i = 0; i < result.grid.n_x; ++i)
      std::putchar(".ox"[static_cast<int>(result.zones[static_cast<std::size_t>(j * result.grid.n_x + i)])]);
    std::putchar('\n');
  }
  if (result.curve.empty()) return;
  std::printf("%12s %12s %12s %12s %12s %8s\n", "xi", "eta", "phi 1/m", "Fx N", "Fy N", "stick");
  for (const auto& p : result.curve)
    std::printf("%12.4e %12.4e %12.4e %12.2f %12.2f %8.3f\n", p.creepage.longitudinal, p.creepage.lateral,
                p.creepage.spin, p.force.longitudinal, p.force.lateral, p.stick_share);
}

// Elements in the order of the fields: along the rail first.
std::vector<proto::NamedArray> element_arrays(const ContactCase& input, const ContactResult& result) {
  const PatchGrid& grid = result.grid;
  PatchField x = grid.zeros(), y = grid.zeros();
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i) x(i, j) = grid.x(i), y(i, j) = grid.y(j);
  std::vector<double> zone;
  for (const Zone z : result.zones) zone.push_back(static_cast<double>(z));
  const bool rolling = input.motion == ContactMotion::rolling;
  const double per = rolling ? 1 / grid.dx : 1.0;
  const std::string unit = rolling ? "1" : "m",
                    what = rolling ? " over the rail per distance rolled" : " over the rail";
  return {{"element/x", "m", "centre along the rail, the wheel rolls to +x", flat(x)},
          {"element/y", "m", "centre across the rail", flat(y)},
          {"element/gap", "m", "before deformation", flat(result.gap.height)},
          {"element/pressure", "Pa", "", flat(result.normal.pressure)},
          {"element/shear_x", "Pa", "on the wheel, along", flat(result.friction.traction.x)},
          {"element/shear_y", "Pa", "on the wheel, across", flat(result.friction.traction.y)},
          {"element/slip_x", unit, "of the wheel" + what, flat(result.friction.slip.x * per)},
          {"element/slip_y", unit, "of the wheel" + what, flat(result.friction.slip.y * per)},
          {"element/zone", "1", "0 open, 1 stick, 2 slip", zone}};
}

std::vector<proto::NamedArray> curve_arrays(const ContactResult& result) {
  std::vector<proto::NamedArray> arrays{{"curve/longitudinal_creepage", "1", "xi", {}},
                                        {"curve/lateral_creepage", "1", "eta", {}},
                                        {"curve/spin", "1/m", "phi", {}},
                                        {"curve/longitudinal_force", "N", "on the wheel", {}},
                                        {"curve/lateral_force", "N", "on the wheel", {}},
                                        {"curve/spin_moment", "N m", "on the wheel, about the normal", {}},
                                        {"curve/stick_share", "1", "of the patch's area", {}}};
  for (const auto& p : result.curve) {
    const double row[] = {p.creepage.longitudinal, p.creepage.lateral, p.creepage.spin, p.force.longitudinal,
                          p.force.lateral,         p.force.moment,     p.stick_share};
    for (std::size_t k = 0; k < arrays.size(); ++k) arrays[k].values.push_back(row[k]);
  }
  return arrays;
}

void write_result(const ContactCase& input, const ContactResult& result, const proto::CaseFile& file,
                  const std::string& program, const std::string& path) {
  auto arrays = element_arrays(input, result);
  const auto scalar = [&](const char* name, const char* unit, const char* what, double value) {
    arrays.push_back({name, unit, what, {value}});
  };
  scalar("grid/n_x", "1", "elements along the rail, the faster index", result.grid.n_x);
  scalar("grid/n_y", "1", "elements across the rail", result.grid.n_y);
  scalar("normal/approach", "m", "", result.normal.approach);
  scalar("normal/force", "N", "", result.normal.force);
  scalar("normal/stiffness", "N/m", "d force/d approach", result.normal.tangent);
  scalar("normal/area", "m2", "", result.area);
  scalar("shear/longitudinal", "N", "on the wheel", result.point.force.longitudinal);
  scalar("shear/lateral", "N", "on the wheel", result.point.force.lateral);
  scalar("shear/moment", "N m", "on the wheel, about the normal", result.point.force.moment);
  if (!result.curve.empty())
    for (auto& array : curve_arrays(result)) arrays.push_back(std::move(array));
  proto::write_array_file(path, arrays, proto::provenance(program, file.name(), file.hash(), file.text()));
}

}  // namespace

void run_contact(const std::string& path, const std::string& program, const ContactAnalyser& blocks,
                 const std::string& out) {
  const auto file = proto::CaseFile::load(path);
  const ContactCase input = read_contact(file);
  if (input.bodies == ContactBodies::blocks && !blocks)
    throw proto::Error(proto::ExitCode::config, program + " has no solid elements", "contact.bodies",
                       "take fem_solver, or bodies = \"half_space\"");
  const ContactResult result = input.bodies == ContactBodies::blocks ? blocks(input) : analyse_contact(input);
  print_patch(input, result);
  print_friction(input, result);
  const std::string target = out + "/contact.h5";
  write_result(input, result, file, program, target);
  std::printf("results: %s\n", target.c_str());
}

}  // namespace fem
