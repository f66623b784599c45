// What people look at after a coupled run of the real solvers: the page of coupler report in headless Chromium, the
// plot in Python, the picture by ParaView.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"

namespace {

namespace fs = std::filesystem;
using tests::contains;

/// Exit code and output of a command of the shell.
std::pair<int, std::string> shell(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text};
}

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

const std::string page_file = tests::bin_folder + "/report_page.html";
const std::string hostile_name = "<img src=x onerror=window.hacked=1>";

/// 300 windows of stones, rail and wheel with every record, under a name and a comment that would be markup.
struct SmallRun {
  SmallRun() {
    setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1);
    auto text = "# The stones' answer </script><script>window.hacked=2</script>\n" +
                tests::solver_case({{"duration_s", "0.03"}, {"speed_m_per_s", "2.0"}});
    text.replace(text.find("[qdem]\n"), 7, "[qdem]\nsensor_interval_s = 1e-4\ncontact_output = true\n");
    for (const auto& [name, kind] : {std::pair{"layer", "stones"}, {"sole", "bottom"}, {"cells", "pressure"}}) {
      text += std::string("\n[[qdem.sensor]]\nname = \"") + name + "\"\nkind = \"" + kind + "\"\n";
      if (kind != std::string("stones")) text += "cells = [2, 3]\n";
    }
    const auto case_folder = folder.file(hostile_name);
    fs::create_directory(case_folder);
    std::ofstream(case_folder + "/case.toml") << text;
    log = shell(tests::bin_folder + "/coupler run " + quoted(case_folder + "/case.toml") + " --out " + out());
    fs::copy(out(), folder.file("second"), fs::copy_options::recursive);
  }
  std::string out() const { return folder.file("first"); }

  tests::TemporaryFolder folder;
  std::pair<int, std::string> log;
};

SmallRun& small_run() {
  static SmallRun run;
  return run;
}

std::string pictures_folder() {
  const std::string folder = tests::bin_folder + "/../test_pictures";
  fs::create_directories(folder);
  return folder;
}

TEST(ReportCommand, SaysWhatIsWrong) {
  const tests::TemporaryFolder bare;
  fs::copy_file(tests::bin_folder + "/coupler", bare.file("coupler"));
  const auto [code, text] = shell(bare.file("coupler") + " report " + bare.path());
  EXPECT_EQ(code, 66) << text;
  EXPECT_TRUE(contains(text, "this build has no report page")) << text;
  EXPECT_TRUE(contains(text, "install nodejs and npm")) << text;
  EXPECT_EQ(shell(tests::bin_folder + "/coupler report").first, 64);
  if (!fs::exists(page_file)) GTEST_SKIP() << "NOT RUN: this build has no report page";
  EXPECT_EQ(shell(tests::bin_folder + "/coupler report /no/such/folder").first, 66);
}

TEST(ReportCommand, WritesOneFileBelowItsLimit) {
  if (!fs::exists(page_file)) GTEST_SKIP() << "NOT RUN: this build has no report page";
  auto& run = small_run();
  ASSERT_EQ(run.log.first, 0) << run.log.second;
  const auto file = run.folder.file("small.html");
  std::uintmax_t before = 0;
  for (const char* limit : {"1.2", "1.5", "30"}) {
    const auto [code, text] =
        shell(tests::bin_folder + "/coupler report " + run.out() + " --size-limit " + limit + " --out " + file);
    ASSERT_EQ(code, 0) << text;
    EXPECT_LE(fs::file_size(file), std::stod(limit) * 1e6) << limit;
    EXPECT_GT(fs::file_size(file), before) << "less is left out of a larger page";
    before = fs::file_size(file);
  }
  const auto page = tests::read_text(file);
  EXPECT_FALSE(contains(page, "<img")) << "the case's name";
  EXPECT_FALSE(contains(page, "window.hacked=2</script>"));
  EXPECT_TRUE(contains(page, "default-src 'none'; script-src 'sha256-"));
}

TEST(ReportPage, IsSeenAndUsedInABrowser) {
  if (!fs::exists(page_file)) GTEST_SKIP() << "NOT RUN: this build has no report page";
  if (shell("command -v chromium").first != 0) GTEST_SKIP() << "NOT RUN: chromium is not installed";
  auto& run = small_run();
  ASSERT_EQ(run.log.first, 0) << run.log.second;
  const std::string program = tests::bin_folder + "/coupler report ";
  ASSERT_EQ(shell(program + run.out()).first, 0);
  ASSERT_EQ(shell(program + run.out() + " " + run.folder.file("second")).first, 0);
  const auto pictures = pictures_folder();
  const auto [code, text] =
      shell("timeout 170 " HOUSE_NODE " " HOUSE_SOURCE_DIR "/tests/integration/report_in_browser.mjs " +
            std::string(HOUSE_REPORT_MODULES " \"$(command -v chromium)\" ") + run.out() + "/report.html " + run.out() +
            "/comparison.html " + pictures);
  ASSERT_EQ(code, 0) << text;
  for (const char* name : {"report.png", "report_view.png", "report_dark.png"}) {
    EXPECT_GT(fs::file_size(pictures + "/" + name), 10000u);
  }
  std::printf("%s", text.c_str());
}

TEST(PlotInPython, IsDrawn) {
  const std::string python = "/usr/bin/python3 ";
  if (shell(python + "-c 'import h5py, matplotlib'").first != 0) GTEST_SKIP() << "NOT RUN: no h5py or matplotlib";
  auto& run = small_run();
  ASSERT_EQ(run.log.first, 0) << run.log.second;
  const auto picture = pictures_folder() + "/plot.png";
  const auto [code, text] = shell(python + HOUSE_SOURCE_DIR "/cases/plot_run.py " + run.out() + " " + picture);
  ASSERT_EQ(code, 0) << text;
  EXPECT_GT(fs::file_size(picture), 10000u);
  EXPECT_NE(shell(python + HOUSE_SOURCE_DIR "/cases/plot_run.py " + run.folder.path()).first, 0) << "no run is there";
}

TEST(PictureByParaView, ShowsTheDeformedTrack) {
  if (shell("command -v pvbatch && command -v xvfb-run").first != 0)
    GTEST_SKIP() << "NOT RUN: paraview or xvfb is not installed";
  auto& run = small_run();
  ASSERT_EQ(run.log.first, 0) << run.log.second;
  const auto picture = pictures_folder() + "/paraview.png";
  fs::remove(picture);
  const auto [code, text] =
      shell("timeout 170 xvfb-run -a pvbatch " HOUSE_SOURCE_DIR "/cases/view_run.py " + run.out() + " " + picture);
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(contains(text, "largest displacement")) << text;
  EXPECT_GT(fs::file_size(picture), 10000u);
}

}  // namespace
