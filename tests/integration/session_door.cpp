// The way in by TCP: who may come, with which key, and who does not disturb whom.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/integration/raw_peer.hpp"
#include "tests/integration/session_harness.hpp"

using namespace proto;
using tests::MockParticipant;
using tests::SessionHarness;

namespace {

class SessionDoor : public SessionHarness {
 protected:
  void SetUp() override {
    mkdir(keys.c_str(), 0700);
    for (const char* name : {"coupler", "mock", "other"}) write_key_pair(keys, name, make_key_pair());
  }

  void open_door(const std::string& folder, const std::set<std::string>& names = {"mock"}) {
    endpoint = std::make_unique<CouplerEndpoint>(directory.path() + "/run", 1 << 20, Admission{{"mock"}, 7, 0.1},
                                                 make_door("tcp://127.0.0.1", folder, names));
  }

  /// Through the door, with the key called `name`, or none.
  SessionOptions through(const std::string& name = {}) const {
    auto result = options();
    result.endpoint = endpoint->door_address();
    if (name.empty()) return result;
    result.server_key = read_public_key(keys + "/coupler.key");
    result.key = read_key_pair(keys + "/" + name + ".key_secret");
    return result;
  }

  /// A whole short session.
  void expect_session(const SessionOptions& way) {
    MockParticipant mock;
    auto served = serve_in_thread(mock, way);
    configure();
    ask<Bye>(Finish{});
    EXPECT_EQ(served.get().code, 0);
  }

  template <class Call>
  static int code_of(Call call) {
    try {
      call();
      return 0;
    } catch (const Error& error) {
      return static_cast<int>(error.code());
    }
  }

  const std::string keys = directory.path() + "/keys";
};

TEST_F(SessionDoor, on_this_machine_needs_no_key) {
  open_door("");
  EXPECT_EQ(endpoint->door_address().rfind("tcp://127.0.0.1:", 0), 0u);
  expect_session(through());
}

TEST_F(SessionDoor, with_a_key_takes_that_key_and_leaves_ipc_alone) {
  open_door(keys);
  expect_session(through("mock"));
  endpoint.reset();
  pending.clear();
  open_door(keys);
  expect_session(options());
}

TEST_F(SessionDoor, the_key_is_that_of_the_name) {
  open_door(keys, {"mock", "other"});
  MockParticipant mock;
  auto served = serve_in_thread(mock, through("other"));
  EXPECT_NE(next_event().problem.find("its key is that of 'other'"), std::string::npos);
  EXPECT_EQ(served.get().code, static_cast<int>(ExitCode::protocol));
}

TEST_F(SessionDoor, who_has_no_listed_key_is_refused_and_told) {
  for (const char* name : {"other", ""}) {
    endpoint.reset();
    pending.clear();
    open_door(keys);
    MockParticipant mock;
    auto served = serve_in_thread(mock, through(name));
    EXPECT_NE(next_event().problem.find("was refused"), std::string::npos);
    const auto outcome = served.get();
    EXPECT_EQ(outcome.code, static_cast<int>(ExitCode::protocol));
    EXPECT_NE(outcome.text.find(*name ? "does not know this key" : "key"), std::string::npos) << outcome.text;
    EXPECT_TRUE(mock.calls.empty());
  }
}

/// Connections that say something that is not ZeroMQ's, and stay.
class Noise {
 public:
  Noise(const std::string& address, int n) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    place.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    for (int i = 0; i < n; ++i) {
      fds_.push_back(socket(AF_INET, SOCK_STREAM, 0));
      EXPECT_EQ(connect(fds_.back(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
      const std::string bytes(static_cast<std::size_t>(1 + 7 * i), static_cast<char>(0xff - i));
      EXPECT_EQ(send(fds_.back(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
  }
  ~Noise() {
    for (const int fd : fds_) close(fd);
  }

 private:
  std::vector<int> fds_;
};

TEST_F(SessionDoor, noise_does_not_disturb) {
  open_door(keys);
  const Noise noise(endpoint->door_address(), 100);
  MockParticipant mock;
  auto served = serve_in_thread(mock, through("mock"));
  EndpointEvent event;
  do event = next_event();
  while (event.participant.empty() && !event.problem.empty());
  ASSERT_TRUE(event.message && std::holds_alternative<Hello>(event.message->body)) << event.problem;
  endpoint.reset();
  EXPECT_EQ(served.get().code, static_cast<int>(ExitCode::unavailable));
}

TEST_F(SessionDoor, is_not_made_for_others_without_keys) {
  for (const char* address : {"tcp://0.0.0.0", "tcp://*:5555", "tcp://10.0.0.1", "tcp://[::1]", "tcp://127.0.0.1.org:5",
                              "tcp://127.0.0.1;10.0.0.1:5", "udp://127.0.0.1", "x"})
    EXPECT_EQ(code_of([&] { make_door(address, "", {}); }), static_cast<int>(ExitCode::usage)) << address;
  EXPECT_EQ(code_of([&] { make_door("tcp://0.0.0.0", keys, {"mock"}); }), 0);
  EXPECT_EQ(code_of([&] { make_door("tcp://0.0.0.0", keys, {"nobody"}); }), static_cast<int>(ExitCode::missing_input));
}

TEST_F(SessionDoor, keys_are_refused_when_they_are_open_torn_or_mixed) {
  const auto secret = keys + "/mock.key_secret", copy = keys + "/copy";
  const auto code = [&] { return code_of([&] { read_key_pair(copy); }); };
  const auto text = [](const std::string& path) {
    std::ifstream file(path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto write = [&](const std::string& content) { write_private_file(copy, content); };
  EXPECT_EQ(code(), static_cast<int>(ExitCode::missing_input));
  write(text(secret));
  EXPECT_EQ(code(), 0);
  for (const mode_t mode : {0640, 0604, 0660}) {
    chmod(copy.c_str(), mode);
    EXPECT_EQ(code(), static_cast<int>(ExitCode::bad_data)) << mode;
  }
  write(text(secret).substr(0, text(secret).size() - 9));
  EXPECT_EQ(code(), static_cast<int>(ExitCode::bad_data)) << "torn";
  const auto other = text(keys + "/other.key_secret");
  write(text(keys + "/mock.key") + other.substr(other.find("    secret-key")));
  EXPECT_EQ(code(), static_cast<int>(ExitCode::bad_data)) << "the keys of two pairs";
  EXPECT_EQ(code_of([&] { write_key_pair(keys, "mock", make_key_pair()); }), static_cast<int>(ExitCode::cannot_create));
}

}  // namespace
