#include "qdem_solver/bed/stone_export.hpp"

#include <filesystem>

#include "proto/error.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/bed/surface_file.hpp"

namespace qdem::bed {
namespace {

constexpr std::uint64_t roughness_stream = 100000;  // of random numbers; one more for every stone

}  // namespace

StoneExport export_stones(const proto::CaseFile& file, const std::string& folder, const Roughness& roughness) {
  const Settings settings = read_settings(file);
  const StoneTemplates stones = make_stone_templates(settings.shapes);
  const double millimetres = 1e3 * settings.gradation.size_at(0.5);
  StoneExport result{{}, stones.notes};
  for (std::size_t t = 0; t < stones.templates.size(); ++t) {
    const Template& stone = stones.templates[t];
    Random random(settings.seed, roughness_stream + t);
    const auto stem = std::filesystem::path(stone.name).stem().string();
    result.files.push_back((std::filesystem::path(folder) / (stem + ".stl")).string());
    if (std::filesystem::exists(result.files.back()))
      throw proto::Error(proto::ExitCode::cannot_create, "the file exists already", result.files.back(),
                         "give an empty folder");
    write_stl(result.files.back(), roughened(skin_of(stone), roughness, random), millimetres);
  }
  return result;
}

}  // namespace qdem::bed
