// Figures, summary and output folder of a run.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "coupler/record/figures.hpp"
#include "coupler/record/run_folder.hpp"
#include "coupler/record/socket_folder.hpp"
#include "coupler/record/summary.hpp"
#include "proto/error.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

proto::RailSeat seat(const std::string& name, int n, int m) {
  proto::RailSeat result;
  result.name = name;
  result.origin.setZero();
  result.axes.setIdentity();
  result.half_lengths = {0.1, 0.1};
  result.cells = {n, m};
  return result;
}

TEST(Figures, SumForcesAndAverageDisplacementsAlongTheNormal) {
  const std::vector<proto::RailSeat> seats{seat("a", 2, 1), seat("b", 1, 1)};
  coupler::WindowRecord record;
  record.impulse = {9, 9, -1, 9, 9, -3, 9, 9, 0.5};
  record.rail_displacement = {9, 9, -2, 9, 9, -4, 9, 9, 1};
  record.sleeper_displacement = {9, 9, -1, 9, 9, -2, 9, 9, 0.5};
  const auto forces = coupler::seat_forces(record, seats, 0.5);
  EXPECT_EQ(forces, (std::vector<double>{-8.0, 1.0}));
  std::vector<coupler::SeatFigures> figures{{"a", 0, 0, 0}, {"b", 0, 0, 0}};
  coupler::update_figures(figures, record, seats, 0.5);
  record.impulse.assign(9, 0.0);
  coupler::update_figures(figures, record, seats, 0.5);
  EXPECT_DOUBLE_EQ(figures[0].max_force_n, 8.0);
  EXPECT_DOUBLE_EQ(figures[0].max_rail_displacement_m, 3.0);
  EXPECT_DOUBLE_EQ(figures[0].max_sleeper_displacement_m, 1.5);
  EXPECT_DOUBLE_EQ(figures[1].max_force_n, 1.0);
}

TEST(Summary, PutsFactsUnderTheirDottedKeys) {
  coupler::Summary summary;
  summary.status = "ok";
  summary.seats = {{"seat", 65e3, 1e-3, 5e-4}};
  summary.facts = {{"bed.stones", 1200.0, ""},      {"bed.porosity", 0.41, ""}, {"bed.cache.hash", std::nullopt, "ab"},
                   {"status", std::nullopt, "ok?"}, {"windows.odd", 1.0, ""},   {"bed.stones", 7.0, ""}};
  const auto json = nlohmann::json::parse(coupler::summary_text(summary));
  EXPECT_EQ(json["bed"]["stones"], 1200);
  EXPECT_TRUE(json["bed"]["stones"].is_number_integer());
  EXPECT_EQ(json["bed"]["porosity"], 0.41);
  EXPECT_EQ(json["bed"]["cache"]["hash"], "ab");
  EXPECT_EQ(json["status"], "ok") << "a fact replaced a figure of the coupler's";
  EXPECT_EQ(json["facts"]["status"], "ok?");
  EXPECT_EQ(json["facts"]["windows.odd"], 1);
  EXPECT_EQ(json["facts"]["bed.stones"], 7);
  EXPECT_EQ(json["rail_seats"][0]["max_force_n"], 65e3);
  EXPECT_FALSE(json.contains("failure"));
}

TEST(Summary, AFailureIsTold) {
  coupler::Summary summary;
  summary.status = "failed";
  summary.rest = {std::numeric_limits<double>::infinity(), 4e-3, 2e-3};
  summary.failure = {"fem: \"lost\"", "fem", 69};
  const auto json = nlohmann::json::parse(coupler::summary_text(summary));
  EXPECT_EQ(json["failure"]["message"], "fem: \"lost\"");
  EXPECT_EQ(json["failure"]["culprit"], "fem");
  EXPECT_EQ(json["failure"]["exit_code"], 69);
  EXPECT_TRUE(json["initialise"]["change_relative"].is_null());
  EXPECT_EQ(json["initialise"]["qdem_residual"], 4e-3);
  EXPECT_EQ(json["initialise"]["fem_residual"], 2e-3);
}

TEST(RunFolder, IsLockedForItsLife) {
  const tests::TemporaryFolder parent;
  const auto path = parent.file("a/b");
  {
    const coupler::RunFolder folder(path, "case");
    EXPECT_EQ(folder.path(), path);
    EXPECT_THROW(coupler::RunFolder(path, "case"), proto::Error);
  }
  const coupler::RunFolder again(path, "case");
  EXPECT_EQ(again.file("x"), path + "/x");
}

TEST(RunFolder, RefusesContentAndFiles) {
  const tests::TemporaryFolder parent;
  std::ofstream(parent.file("old")) << "results";
  EXPECT_THROW(coupler::RunFolder(parent.path(), "case"), proto::Error);
  EXPECT_THROW(coupler::RunFolder(parent.file("old"), "case"), proto::Error);
}

/// Socket folders are made in a temporary folder.
class SocketFolder : public ::testing::Test {
 protected:
  SocketFolder() { setenv("XDG_RUNTIME_DIR", parent_.path().c_str(), 1); }
  ~SocketFolder() override { unsetenv("XDG_RUNTIME_DIR"); }

  /// A folder of `mode` as a coupler that was killed leaves it, with its socket.
  std::string left_behind(const std::string& name, mode_t mode = 0700) const {
    const auto path = parent_.file(name);
    EXPECT_EQ(mkdir(path.c_str(), mode), 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    (path + "/coupler").copy(address.sun_path, sizeof address.sun_path - 1);
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    close(fd);
    return path;
  }

  tests::TemporaryFolder parent_;
};

TEST_F(SocketFolder, IsPrivateAndGoesAway) {
  std::string path;
  {
    const coupler::SocketFolder folder;
    path = folder.path();
    EXPECT_EQ(std::filesystem::path(path).parent_path(), parent_.path());
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700u);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(SocketFolder, RemovesWhatADeadCouplerLeftAndNothingElse) {
  const auto dead = left_behind("qdem-fem-a1b2c3"), open_to_others = left_behind("qdem-fem-d1d2d3", 0755),
             longer_name = left_behind("qdem-fem-a1b2c3d4"), with_results = left_behind("qdem-fem-e1e2e3");
  std::ofstream(with_results + "/results") << "mine";
  const coupler::SocketFolder alive;
  const coupler::SocketFolder next;
  EXPECT_FALSE(std::filesystem::exists(dead));
  for (const auto& path :
       {alive.path(), next.path(), open_to_others + "/coupler", longer_name + "/coupler", with_results + "/results"})
    EXPECT_TRUE(std::filesystem::exists(path)) << path;
}

}  // namespace
