// Messages that a participant has to refuse: with a Fault and its exit code, not with a crash, never by taking them.
#include <fmt/format.h>

#include <limits>

#include "coupler/conformance/check.hpp"
#include "coupler/conformance/subject.hpp"
#include "proto/wire/codec.hpp"

namespace coupler::conformance {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double refusal_limit_s = 5.0;  // it does not compute: an answer is due at once
constexpr auto protocol_code = static_cast<int>(proto::ExitCode::protocol);
constexpr auto numerics_code = static_cast<int>(proto::ExitCode::numerics);

/// "" when it ended as it should.
std::string wrong_refusal(const Ending& end, const std::string& what, bool may_be_silent = false) {
  const auto text = [&](const std::string& how) { return fmt::format("{}: {} ({})", what, how, end.text()); };
  if (!end.exit) return text("it was taken");
  if (end.exit->signal) return text("it crashed");
  if (end.exit->code == 0) return text("it ended as if all were well");
  if (may_be_silent) return {};
  if (!end.fault) return text("no Fault was sent");
  if (end.fault->code != end.exit->code)
    return text(fmt::format("its Fault has the code {} and its exit another", end.fault->code));
  if (end.exit->code != protocol_code && end.exit->code != numerics_code)
    return text(fmt::format("{} was expected", protocol_code));
  return {};
}

/// Brings a participant to `stage`, sends what `make` makes of it and judges its end.
template <class Make>
std::string refusal_of(Bench& bench, Stage stage, const std::string& what, Make make, bool may_be_silent = false) {
  Subject subject(bench);
  subject.bring_to(stage);
  subject.send_bytes(make(subject));
  return wrong_refusal(subject.ending(refusal_limit_s), what, may_be_silent);
}

Verdict verdict_of(std::initializer_list<std::string> texts) {
  for (const auto& text : texts)
    if (!text.empty()) return fail(text);
  return pass();
}

Bytes frame_of(const Subject& subject, proto::Body body) {
  return proto::encode(subject.next_message(std::move(body)));
}

Verdict bad_order(Bench& bench) {
  return verdict_of({refusal_of(bench, Stage::registered, "Start before Configure",
                                [](const Subject& subject) { return frame_of(subject, proto::Start{}); }),
                     refusal_of(bench, Stage::marching, "Commit of a window that was not advanced",
                                [](const Subject& subject) { return frame_of(subject, proto::Commit{0}); }),
                     refusal_of(bench, Stage::marching, "Advance of a window too late",
                                [](const Subject& subject) {
                                  auto request = subject.request();
                                  request.window += 5;
                                  return frame_of(subject, request);
                                }),
                     refusal_of(bench, Stage::advanced, "Finish in the middle of a window",
                                [](const Subject& subject) { return frame_of(subject, proto::Finish{}); })});
}

/// The due request with a change in the last value of each of its fields.
template <class Change>
Bytes changed_advance(const Subject& subject, Change change) {
  const auto due = subject.request();
  auto request = due;
  for (const auto& values : due.data.all()) {
    auto changed = values.values;
    change(changed);
    request.data.set(values.name, changed);
  }
  return frame_of(subject, request);
}

Verdict bad_values(Bench& bench) {
  const auto with = [&](const char* what, double value) {
    return refusal_of(bench, Stage::marching, what, [&](const Subject& subject) {
      return changed_advance(subject, [&](std::vector<double>& values) { values.back() = value; });
    });
  };
  return verdict_of({with("an Advance with NaN", std::numeric_limits<double>::quiet_NaN()),
                     with("an Advance with an infinity", std::numeric_limits<double>::infinity())});
}

Verdict bad_length(Bench& bench) {
  return verdict_of({refusal_of(bench, Stage::marching, "an Advance with a value too many",
                                [](const Subject& subject) {
                                  return changed_advance(subject,
                                                         [](std::vector<double>& values) { values.push_back(0.0); });
                                }),
                     refusal_of(bench, Stage::marching, "an Advance with a value too few", [](const Subject& subject) {
                       return changed_advance(subject, [](std::vector<double>& values) { values.pop_back(); });
                     })});
}

Verdict bad_bytes(Bench& bench) {
  const auto with = [&](const char* what, void (*damage)(Bytes&)) {
    return refusal_of(bench, Stage::marching, what, [&](const Subject& subject) {
      auto frame = frame_of(subject, subject.request());
      damage(frame);
      return frame;
    });
  };
  return verdict_of({with("a flipped bit in the payload", [](Bytes& frame) { frame[frame.size() / 2] ^= 4; }),
                     with("a flipped bit in the hash", [](Bytes& frame) { frame[9] ^= 1; }),
                     with("a frame without its last 8 bytes", [](Bytes& frame) { frame.resize(frame.size() - 8); }),
                     with("an empty frame", [](Bytes& frame) { frame.clear(); })});
}

Verdict bad_session(Bench& bench) {
  const auto with = [&](const char* what, void (*change)(proto::Message&)) {
    return refusal_of(bench, Stage::marching, what, [&](const Subject& subject) {
      auto message = subject.next_message(subject.request());
      change(message);
      return proto::encode(message);
    });
  };
  return verdict_of({with("a message of another session", [](proto::Message& message) { message.session ^= 1; }),
                     with("a message after a gap", [](proto::Message& message) { ++message.sequence; })});
}

Verdict oversize(Bench& bench) {
  constexpr std::size_t too_many_bytes = 96u << 20;  // the protocol's limit is 64 MiB
  const auto text = refusal_of(
      bench, Stage::marching, "a frame of 96 MiB",
      [](const Subject& subject) {
        auto frame = frame_of(subject, subject.request());
        frame.resize(too_many_bytes);
        return frame;
      },
      true);
  return verdict_of({text});
}

}  // namespace

std::vector<Check> message_checks() {
  return {{"bad_order", "refuses messages out of order", Role::both, bad_order},
          {"bad_values", "refuses numbers that are not finite", Role::both, bad_values},
          {"bad_length", "refuses fields of wrong length", Role::both, bad_length},
          {"bad_bytes", "refuses damaged frames", Role::both, bad_bytes},
          {"bad_session", "refuses another session, and gaps in the numbering", Role::both, bad_session},
          {"oversize", "refuses a frame of more than 64 MiB, or ends the connection", Role::both, oversize}};
}

}  // namespace coupler::conformance
