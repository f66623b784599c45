#include "qdem_solver/app/commands.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "proto/case/case_file.hpp"
#include "proto/case/case_schema.hpp"
#include "proto/error.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/bed/stone_export.hpp"
#include "qdem_solver/bench/device_report.hpp"
#include "qdem_solver/bench/report.hpp"
#include "qdem_solver/contact/entry_laws.hpp"
#include "qdem_solver/output/bed_file.hpp"
#include "qdem_solver/output/fields_file.hpp"
#include "qdem_solver/participant/run_alone.hpp"
#include "qdem_solver/participant/track_bed.hpp"

namespace qdem {
namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    throw proto::Error(proto::ExitCode::cannot_create, "the folder cannot be made (" + error.message() + ")",
                       folder.string());
  }
}

void print_facts(const std::vector<proto::Fact>& facts) {
  for (const auto& fact : facts) {
    fmt::print("  {:32} {}\n", fact.key, fact.number ? fmt::format("{:.6g}", *fact.number) : fact.text);
  }
}

void print_ledger(const EnergyBalance& energy, double largest_residual) {
  fmt::print(
      "energy                    {:.4g} J of work; dissipated: elements {:.3g}, contact dashpots {:.3g}, "
      "friction {:.3g} J; radiated {:.3g} J\n",
      energy.work, energy.viscous, energy.contact_dashpots, energy.friction, energy.radiated);
  fmt::print("energy residual           {:.2e} of {:.3g} J that were moved, {:.2e} at most\n", energy.relative(),
             energy.scale, largest_residual);
}

}  // namespace

void check_command(const proto::CaseFile& file) {
  check_case(file);
  for (const std::string& warning : check_bed(file, read_qdem_case(file).physics)) spdlog::warn("{}", warning);
}

void schema_command() {
  // Two materials must be there; a third one shows that a case may have names of its own.
  const std::string common = R"(
bed.stone_materials = ["stone", "x"]
qdem.material = [{name = "stone"}, {name = "sleeper"}, {name = "x"}]
rail_seat = [{half_lengths_m = [0.05, 0.05]}]
)";
  std::vector<std::string> seeds;  // one for each way in which a contact's stiffness and damping may be given
  for (const char* contact : {"{normal_stiffness_n_per_m = 1e6, damping_ratio = 0.5}",
                              "{hertz_load_n = 1.0, hertz_radius_m = 1.0, restitution = 0.5}",
                              "{contact_time_s = 1e-3, contact_mass_kg = 1.0, damping_ratio = 0.5}"}) {
    seeds.push_back(common + "qdem.contact = " + contact + "\n");
  }
  fmt::print("{}\n", proto::case_schema({[](const proto::CaseFile& file) { read_qdem_case(file); },
                                         [](const proto::CaseFile& file) { bed::read_settings(file); }},
                                        seeds));
}

void print_figures(const proto::CaseFile& file) {
  const BedPhysics physics = read_qdem_case(file).physics;
  const SleeperFigures sleeper = sleeper_figures(file, physics);
  fmt::print("sleeper                   {:.1f} kg, step bound {:.4g} s without contacts\n", sleeper.mass,
             sleeper.step_bound);
  const auto print_contact = [&](const char* name, const Bearing& bearing) {
    const ContactLaw law = in_series(physics.contact, bearing);
    fmt::print("{:25} {:.4g} N/m", name, law.normal_stiffness);
    if (!bearing.is_rigid()) fmt::print(" and {:.4g} N s/m in series", law.normal_damping);
    fmt::print("\n");
  };
  print_contact("contact point", {});
  if (!physics.lining.is_rigid()) print_contact("  on the sleeper's pad", physics.lining);
  if (!physics.ground.is_rigid()) print_contact("  on the ground", physics.ground);
}

Bed bed_of_case(const proto::CaseFile& file, const BedPhysics& physics) {
  return make_bed(file, physics);
}

void run_command(const std::string& case_path, const std::string& out) {
  const auto file = proto::CaseFile::load(case_path);
  check_command(file);
  make_folder(out);
  const auto report = [](double time) {
    if (isatty(fileno(stderr)) != 0) fmt::print(stderr, "\rt = {:.6f} s", time);
  };
  const auto warn = [](const std::string& line) { spdlog::warn("{}", line); };
  const auto figures = run_alone(file, bed_of_case, out, report, warn);
  if (isatty(fileno(stderr)) != 0) fmt::print(stderr, "\n");
  const EnergyBalance& energy = figures.energy;
  fmt::print("steps                     {} of {:.4g} to {:.4g} s\n", figures.steps, figures.smallest_step,
             figures.largest_step);
  fmt::print("wall time                 {:.2f} s ({:.1f} million element updates a second)\n", figures.wall,
             1e-6 * figures.element_updates_per_s);
  fmt::print("sleeper at the seats      {:.4f} mm along their normal\n", 1e3 * figures.sleeper_displacement);
  fmt::print("pad force on the sleeper  {:.1f} N along the normal\n", figures.pad_force);
  fmt::print("kinetic energy            {:.3e} J\n", energy.stored.kinetic);
  if (energy.open) print_ledger(energy, figures.largest_residual);
  fmt::print("coordination number       {:.2f}\n", figures.coordination_number);
  if (!figures.output.empty()) fmt::print("fields                    {}\n", figures.output);
}

void bed_command(const std::string& case_path, const std::string& path) {
  const auto file = proto::CaseFile::load(case_path);
  check_command(file);
  make_folder(std::filesystem::path(path).parent_path());
  const std::filesystem::path target(path);
  const auto view_path = target.parent_path() / (target.stem().string() + "_fields.h5");
  // The figures and the fields are of the bed under its pads; the file holds the bed as it was built.
  TrackBed bed(file,
               [&](const proto::CaseFile& the_file, const BedPhysics& physics) {
                 Bed built = bed_of_case(the_file, physics);
                 write_bed_file(path, built);
                 return built;
               },
               {});
  FieldsFile fields(view_path.string(), bed.model(), bed.state(), bed.attributes(file));
  fields.write(0.0, bed.state(), bed.engine(), bed.engine().balance(bed.state()));
  fields.close();
  fmt::print("bed    {}\nfields {}\n", path, view_path.string());
  print_facts(bed.facts());
}

void bench_command(const std::string& case_path, const std::string& json_path) {
  std::optional<bench::Scene> settled;
  if (!case_path.empty()) {
    const auto file = proto::CaseFile::load(case_path);
    check_command(file);
    TrackBed bed(file, bed_of_case, {});
    settled = bench::Scene{bed.model(), bed.state()};
  }
  const auto report = bench::measure(settled ? &*settled : nullptr);
  fmt::print("{}", bench::table(report));
  if (json_path.empty()) return;
  std::ofstream out(json_path);
  out << report.dump(2) << "\n";
  if (!out.flush()) {
    throw proto::Error(proto::ExitCode::cannot_create, "the report cannot be written", json_path);
  }
}

void device_bench_command() {
  fmt::print("{}", bench::device_table());
}

void stones_command(const std::string& case_path, const std::string& folder, const bed::Roughness& roughness) {
  const auto file = proto::CaseFile::load(case_path);
  check_command(file);
  make_folder(folder);
  const auto stones = bed::export_stones(file, folder, roughness);
  for (const auto& note : stones.notes) fmt::print("{}\n", note);
  for (const auto& path : stones.files) fmt::print("stone  {}\n", path);
}

}  // namespace qdem
