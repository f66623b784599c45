// The supervisor with a real participant: what it makes of messages and exits that come in any order.
#include "coupler/supervise/supervisor.hpp"

#include <gtest/gtest.h>

#include "proto/case/case_file.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

class WithOneParticipant : public ::testing::Test {
 protected:
  WithOneParticipant() {
    std::ofstream(case_path_) << tests::OscillatorCase{}.text();
    const auto hash = proto::CaseFile::load(case_path_).hash();
    endpoint_ = std::make_unique<proto::CouplerEndpoint>(folder_.file("socket"), 1 << 20,
                                                         proto::Admission{{"qdem"}, hash, 0.2});
    supervisor_ = std::make_unique<coupler::Supervisor>(children_, *endpoint_, coupler::Patience{10, 10, 10, 10});
  }

  void start() {
    const auto program = tests::bin_folder + "/oscillator_participant";
    supervisor_->add("qdem", program, folder_.file("log"));
    children_.start({"qdem",
                     {program, "participant", "--side", "explicit", "--case", case_path_, "--endpoint",
                      endpoint_->address(), "--out", folder_.path(), "--name", "qdem"},
                     {{"QDEM_FEM_SESSION_TOKEN", endpoint_->session_token()}},
                     folder_.file("log")});
    EXPECT_EQ(supervisor_->await_hellos().count("qdem"), 1u);
    supervisor_->await<proto::Interface>("qdem", 0, true);
    proto::Configure configure;
    configure.window_s = 0.1;
    configure.windows = 1;
    configure.output_directory = folder_.path();
    supervisor_->await<proto::Configured>("qdem", supervisor_->send("qdem", configure), true);
  }

  tests::TemporaryFolder folder_;
  std::string case_path_ = folder_.file("case.toml");
  coupler::Children children_{tests::bin_folder + "/coupler"};
  std::unique_ptr<proto::CouplerEndpoint> endpoint_;
  std::unique_ptr<coupler::Supervisor> supervisor_;
};

TEST_F(WithOneParticipant, AByeThatIsReadAfterTheExitIsStillAnEnd) {
  start();
  const auto asked = supervisor_->send("qdem", proto::Finish{});
  // The exit is known before anything is read from the wire.
  while (!children_.exit_of("qdem")) children_.wait(0.05);
  EXPECT_NO_THROW(supervisor_->await<proto::Bye>("qdem", asked));
}

TEST_F(WithOneParticipant, AFaultThatIsReadAfterTheExitIsTheMessage) {
  start();
  supervisor_->send("qdem", proto::Commit{5});  // out of order: the participant refuses and ends
  while (!children_.exit_of("qdem")) children_.wait(0.05);
  try {
    supervisor_->await<proto::Result>("qdem", 0);
    FAIL() << "nothing was thrown";
  } catch (const coupler::ParticipantError& error) {
    EXPECT_EQ(error.participant(), "qdem");
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    EXPECT_TRUE(tests::contains(error.what(), "Commit is out of order")) << error.what();
  }
}

TEST_F(WithOneParticipant, AnotherMessageThanTheOneDueIsNamed) {
  start();
  const auto asked = supervisor_->send("qdem", proto::Start{});
  try {
    supervisor_->await<proto::Configured>("qdem", asked);
    FAIL() << "nothing was thrown";
  } catch (const coupler::ParticipantError& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::protocol);
    EXPECT_TRUE(tests::contains(error.what(), "qdem sent Result")) << error.what();
    EXPECT_TRUE(tests::contains(error.what(), "where Configured was due")) << error.what();
  }
}

}  // namespace
