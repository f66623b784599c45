#include "coupler/conformance/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"
#include "proto/wire/codec.hpp"

namespace coupler::conformance {
namespace {

void compare(const proto::Result& found, const proto::Result& recorded, ReplayReport& report) {
  ++report.n_results;
  const auto text = difference(found, recorded);
  if (report.first_difference.empty() && !text.empty())
    report.first_difference = recorded.phase == proto::Phase::initialise ? "initialise phase, " + text : text;
  for (const auto& [name, values] : recorded.data.all()) {
    auto& departure = report.fields[name];
    const auto& other = found.data.get(name);
    if (other.size() != values.size())
      throw proto::Error(proto::ExitCode::protocol, "'" + name + "' has another length than in the record");
    for (std::size_t i = 0; i < values.size(); ++i) {
      departure.magnitude = std::max(departure.magnitude, std::abs(values[i]));
      if (!(std::abs(values[i] - other[i]) > departure.largest)) continue;
      departure.largest = std::abs(values[i] - other[i]);
      departure.window = recorded.window;
    }
  }
}

/// Plays one participant's messages in their order.
class Player {
 public:
  Player(Subject& subject, std::string folder) : subject_(subject), folder_(std::move(folder)) {}

  /// False at the end of the session.
  bool play(const LoggedFrame& frame, ReplayReport& report) {
    const auto body = proto::decode(frame.bytes).body;
    return frame.sent ? ask(body) : hear(body, report);
  }

 private:
  bool ask(const proto::Body& body) {
    if (std::holds_alternative<proto::Restore>(body))
      throw proto::Error(proto::ExitCode::bad_data, "the record is of a run that was resumed", "",
                         "record a run from its beginning");
    if (std::holds_alternative<proto::Fault>(body)) return false;
    if (std::holds_alternative<proto::Finish>(body)) return subject_.finish(), false;
    if (std::holds_alternative<proto::Save>(body) || std::holds_alternative<proto::Heartbeat>(body)) return true;
    auto request = body;
    if (auto* configure = std::get_if<proto::Configure>(&request)) configure->output_directory = folder_;
    asked_ = subject_.send(std::move(request));
    return true;
  }

  bool hear(const proto::Body& body, ReplayReport& report) {
    if (std::holds_alternative<proto::Configured>(body)) subject_.await<proto::Configured>(asked_, true);
    if (const auto* recorded = std::get_if<proto::Result>(&body))
      compare(subject_.await<proto::Result>(asked_), *recorded, report);
    return true;
  }

  Subject& subject_;
  std::string folder_;
  std::uint64_t asked_ = 0;
};

}  // namespace

double ReplayReport::largest_relative() const {
  double result = 0.0;
  for (const auto& [name, departure] : fields) result = std::max(result, departure.relative());
  return result;
}

ReplayReport replay(Subject& subject, FrameLogReader& log, const std::string& name, const std::string& folder) {
  ReplayReport report;
  subject.bring_to(Stage::registered);
  Player player(subject, folder);
  bool going = true;
  while (going) {
    const auto frame = log.next();
    going = frame && (frame->participant != name || player.play(*frame, report));
  }
  return report;
}

std::string replay_table(const ReplayReport& report) {
  auto text = fmt::format("{} answers compared\n", report.n_results);
  if (report.first_difference.empty()) return text + "every one has the record's bytes\n";
  text += fmt::format("first difference: {}\n\n{:<24}{:>16}{:>16}{:>10}\n", report.first_difference, "field",
                      "largest diff.", "relative", "window");
  for (const auto& [name, departure] : report.fields)
    text += fmt::format("{:<24}{:>16.3e}{:>16.3e}{:>10}\n", name, departure.largest, departure.relative(),
                        departure.window);
  return text;
}

}  // namespace coupler::conformance
