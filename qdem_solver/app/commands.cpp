#include "qdem_solver/app/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"
#include "qdem_solver/bed/stone_export.hpp"
#include "qdem_solver/bench/device_report.hpp"
#include "qdem_solver/bench/report.hpp"
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

}  // namespace

void check_command(const proto::CaseFile& file) {
  check_case(file);
  check_bed(file);
}

Bed bed_of_case(const proto::CaseFile& file, const BedPhysics& physics) {
  return make_bed(file, physics);
}

void run_command(const std::string& case_path, const std::string& out) {
  const auto file = proto::CaseFile::load(case_path);
  check_command(file);
  make_folder(out);
  const auto figures = run_alone(file, bed_of_case, out, [](double time) {
    if (isatty(fileno(stderr)) != 0) fmt::print(stderr, "\rt = {:.6f} s", time);
  });
  if (isatty(fileno(stderr)) != 0) fmt::print(stderr, "\n");
  fmt::print("steps                     {} of {:.4g} to {:.4g} s\n", figures.steps, figures.smallest_step,
             figures.largest_step);
  fmt::print("wall time                 {:.2f} s ({:.1f} million element updates a second)\n", figures.wall,
             1e-6 * figures.element_updates_per_s);
  fmt::print("sleeper at the seats      {:.4f} mm along their normal\n", 1e3 * figures.sleeper_displacement);
  fmt::print("pad force on the sleeper  {:.1f} N along the normal\n", figures.pad_force);
  fmt::print("kinetic energy            {:.3e} J\n", figures.kinetic_energy);
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
  fields.write(0.0, bed.state(), bed.engine());
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
