// Child processes: how they end is known, and none is left behind.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "coupler/launch/children.hpp"
#include "proto/error.hpp"
#include "tests/support/processes.hpp"

namespace {

using coupler::Children;

const std::string helper = std::string(HOUSE_BIN_DIR) + "/coupler";

class Launch : public ::testing::Test {
 protected:
  coupler::ChildSpec shell(const std::string& script) { return {"child", {"/bin/sh", "-c", script}, {}, log()}; }
  std::string log() const { return folder.file("child.log"); }
  int logged_number() const { return std::atoi(tests::read_text(log()).c_str()); }
  bool await_log() const {
    return tests::becomes_true([&] { return tests::read_text(log()).find('\n') != std::string::npos; }, 5.0);
  }
  tests::TemporaryFolder folder;
};

coupler::ChildExit await_exit(Children& children, const std::string& name) {
  for (int i = 0; i < 500 && !children.exit_of(name); ++i) children.wait(0.01);
  const auto exit = children.exit_of(name);
  EXPECT_TRUE(exit) << name << " did not exit";
  return exit.value_or(coupler::ChildExit{});
}

TEST_F(Launch, TellsTheExitCodeAndKeepsTheLog) {
  Children children(helper);
  children.start({"child", {"/bin/sh", "-c", "echo out; echo $TOKEN >&2; exit 7"}, {{"TOKEN", "secret"}}, log()});
  const auto exit = await_exit(children, "child");
  EXPECT_EQ(exit.code, 7);
  EXPECT_EQ(exit.signal, 0);
  EXPECT_EQ(exit.text(), "exited with code 7");
  EXPECT_EQ(tests::read_text(log()), "out\nsecret\n");
  EXPECT_FALSE(children.running());
}

TEST_F(Launch, TellsTheSignal) {
  Children children(helper);
  children.start(shell("kill -9 $$"));
  const auto exit = await_exit(children, "child");
  EXPECT_EQ(exit.signal, SIGKILL);
  EXPECT_EQ(exit.text(), "was killed by signal 9 (Killed)");
}

TEST_F(Launch, AProgramThatCannotBeStartedSaysWhy) {
  Children children(helper);
  children.start({"child", {folder.file("none")}, {}, log()});
  EXPECT_EQ(await_exit(children, "child").code, static_cast<int>(proto::ExitCode::os_error));
  EXPECT_NE(tests::read_text(log()).find("No such file or directory"), std::string::npos);
}

TEST_F(Launch, StopTakesGrandchildrenToo) {
  Children children(helper);
  children.start(shell("sleep 1000 & echo $!; wait"));
  ASSERT_TRUE(await_log());
  const int grandchild = logged_number();
  ASSERT_FALSE(tests::is_gone(grandchild));
  children.stop(1.0);
  EXPECT_FALSE(children.running());
  EXPECT_TRUE(tests::becomes_true([&] { return tests::is_gone(grandchild); }, 1.0));
}

TEST_F(Launch, AnExitTakesGrandchildrenToo) {
  Children children(helper);
  children.start(shell("sleep 1000 & echo $!; exit 0"));
  await_exit(children, "child");
  EXPECT_TRUE(tests::becomes_true([&] { return tests::is_gone(logged_number()); }, 1.0));
}

TEST_F(Launch, WhoIgnoresSigtermIsKilled) {
  Children children(helper);
  children.start(shell("trap '' TERM; echo $$; while :; do sleep 0.05; done"));
  ASSERT_TRUE(await_log());
  children.stop(0.3);
  ASSERT_TRUE(children.exit_of("child"));
  EXPECT_EQ(children.exit_of("child")->signal, SIGKILL);
}

TEST_F(Launch, WhoIsStoppedStillTakesSigterm) {
  Children children(helper);
  children.start(shell("trap 'exit 3' TERM; echo $$; while :; do sleep 0.02; done"));
  ASSERT_TRUE(await_log());
  kill(children.pid_of("child"), SIGSTOP);
  children.stop(3.0);
  ASSERT_TRUE(children.exit_of("child"));
  EXPECT_EQ(children.exit_of("child")->code, 3);
}

TEST_F(Launch, TheDestructorLeavesNothing) {
  int pid = 0;
  {
    Children children(helper);
    children.start(shell("sleep 1000"));
    pid = children.pid_of("child");
    ASSERT_FALSE(tests::is_gone(pid));
  }
  EXPECT_TRUE(tests::is_gone(pid));
}

TEST_F(Launch, ChildrenDieWithTheirParent) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const int parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    Children children(helper);
    children.start(shell("exec sleep 1000"));
    const int pid = children.pid_of("child");
    if (write(pipe_ends[1], &pid, sizeof pid) != sizeof pid) _exit(1);
    for (;;) pause();
  }
  int pid = 0;
  ASSERT_EQ(read(pipe_ends[0], &pid, sizeof pid), static_cast<ssize_t>(sizeof pid));
  // Only after its exec has the child asked for the signal.
  ASSERT_TRUE(tests::becomes_true(
      [&] { return tests::read_text("/proc/" + std::to_string(pid) + "/comm") == "sleep\n"; }, 5.0));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(tests::becomes_true([&] { return tests::is_gone(pid); }, 2.0));
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_F(Launch, ACommandWhoseParentIsGoneDoesNotStart) {
  const auto command = helper + " exec-child 1 /bin/sh -c 'echo ran' > " + log() + " 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), static_cast<int>(proto::ExitCode::unavailable));
  EXPECT_NE(tests::read_text(log()).find("the coupler is gone"), std::string::npos);
}

TEST_F(Launch, StopSignalsAreSeen) {
  Children children(helper);
  EXPECT_EQ(children.stop_signal(), 0);
  raise(SIGTERM);
  children.wait(1.0);
  EXPECT_EQ(children.stop_signal(), SIGTERM);
  EXPECT_EQ(children.n_stop_signals(), 1);
}

}  // namespace
