// `coupler report`: one HTML page of a run, or of several to compare.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "coupler/app/options.hpp"
#include "coupler/launch/program_path.hpp"
#include "coupler/page/page.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

/// The empty page, built by coupler/report_page beside the program.
std::string empty_page() {
  const auto path = std::filesystem::path(own_path()).parent_path() / "report_page.html";
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw proto::Error(
        proto::ExitCode::missing_input,
        "this build has no report page (it is made with npm, which was missing or could not reach its registry)",
        path.string(),
        "install nodejs and npm, then build the target report_page; coupler analyze and the .xdmf files "
        "for ParaView do without");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

int report_runs(const ReportOptions& options) {
  const auto page = empty_page();
  const std::string file = options.folders.size() == 1 ? "/report.html" : "/comparison.html";
  const std::string out = options.out.empty() ? options.folders.front() + file : options.out;
  const auto limit = static_cast<std::size_t>(options.size_limit_mb * 1e6);
  const auto data = page::page_data(options.folders, limit > page.size() ? limit - page.size() : 0);
  const auto text = page::filled_page(page, data);
  proto::write_text_file(out, text);
  fmt::print("{} ({:.1f} MB): open it in a browser\n", out, static_cast<double>(text.size()) * 1e-6);
  return 0;
}

}  // namespace coupler
