#include <xxhash.h>

#include <cmath>
#include <cstring>

#include "coupling_generated.h"
#include "proto/error.hpp"
#include "proto/wire/codec.hpp"
#include "proto/wire/frame.hpp"
#include "schema_text.hpp"

namespace proto {
namespace {

template <class T>
using Table = flatbuffers::Vector<flatbuffers::Offset<T>>;

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ExitCode::protocol, "malformed message: " + problem, "", "see proto/README.md");
}

double finite(double value, const std::string& name) {
  if (!std::isfinite(value))
    throw Error(ExitCode::numerics, "a number that is not finite was received", name,
                "the sender's solution is broken");
  return value;
}

std::string text(const flatbuffers::String* value) {
  return value ? value->str() : std::string();
}

std::vector<double> numbers(const flatbuffers::Vector<double>* values, const std::string& name) {
  std::vector<double> result(values ? values->size() : 0);
  // By bytes: the verifier does not check the alignment of a vector's elements.
  if (!result.empty()) std::memcpy(result.data(), values->Data(), result.size() * sizeof(double));
  for (std::size_t i = 0; i < result.size(); ++i)
    if (!std::isfinite(result[i])) finite(result[i], name + "[" + std::to_string(i) + "]");
  return result;
}

std::vector<bool> flags(const flatbuffers::Vector<std::uint8_t>* values) {
  if (!values) return {};
  return {values->begin(), values->end()};
}

template <class To, class From>
To choice(From value, From last, const char* name) {
  if (static_cast<int>(value) < 0 || value > last)
    refuse(std::string(name) + " has the unknown value " + std::to_string(static_cast<int>(value)));
  return static_cast<To>(value);
}

Phase phase(fbs::Phase value) {
  return choice<Phase>(value, fbs::Phase::MAX, "phase");
}

FieldSet fields(const Table<fbs::Field>* list) {
  FieldSet set;
  for (const auto* field : *list) {
    const auto name = field->name()->str();
    if (set.has(name)) refuse("it has the field '" + name + "' twice");
    set.set(name, numbers(field->values(), name));
  }
  return set;
}

std::vector<Fact> facts(const Table<fbs::Fact>* list) {
  std::vector<Fact> result;
  if (!list) return result;
  for (const auto* fact : *list) {
    result.push_back({fact->key()->str(), fact->number(), text(fact->text())});
    if (fact->number()) finite(*fact->number(), result.back().key);
  }
  return result;
}

SeatRegistration read(const fbs::SeatRegistration& m) {
  const auto name = m.name()->str();
  const auto of_seat = [&](const flatbuffers::Vector<double>* values, const char* field) {
    return numbers(values, name + "." + field);
  };
  return {name,
          of_seat(m.points(), "points"),
          of_seat(m.weights(), "weights"),
          of_seat(m.rigid_response(), "rigid_response"),
          of_seat(m.force_resultants(), "force_resultants"),
          of_seat(m.stiffness(), "stiffness"),
          of_seat(m.damping(), "damping"),
          of_seat(m.preload(), "preload"),
          flags(m.tension_cutoff()),
          m.own_points()};
}

Hello read(const fbs::Hello& m) {
  Hello hello{m.name()->str(), m.protocol_major(),      m.protocol_minor(), m.schema_hash(),
              m.case_hash(),   text(m.session_token()), text(m.build_id()), {}};
  if (const auto* can = m.capabilities())
    hello.capabilities = {can->robin(), can->rollback(), can->save_restore(), can->initialise()};
  return hello;
}
Welcome read(const fbs::Welcome& m) {
  return {m.session(), finite(m.heartbeat_s(), "heartbeat_s")};
}
Reject read(const fbs::Reject& m) {
  return {text(m.reason())};
}
Interface read(const fbs::Interface& m) {
  Interface result;
  for (const auto* spec : *m.fields())
    result.fields.push_back({spec->name()->str(), spec->unit()->str(), spec->components(), spec->outgoing()});
  for (const auto* seat : *m.seats()) result.seats.push_back(read(*seat));
  return result;
}
Configure read(const fbs::Configure& m) {
  return {finite(m.window_s(), "window_s"),
          m.windows(),
          choice<LoadMode>(m.mode(), fbs::LoadMode::MAX, "mode"),
          text(m.output_directory()),
          numbers(m.stiffness(), "stiffness"),
          numbers(m.damping(), "damping"),
          numbers(m.preload(), "preload"),
          flags(m.tension_cutoff()),
          numbers(m.pad_map(), "pad_map")};
}
Configured read(const fbs::Configured& m) {
  if (m.largest_step_s()) finite(*m.largest_step_s(), "largest_step_s");
  if (m.largest_initialise_step_s()) finite(*m.largest_initialise_step_s(), "largest_initialise_step_s");
  return {m.largest_step_s(), facts(m.facts()), m.largest_initialise_step_s()};
}
Start read(const fbs::Start&) {
  return {};
}
Advance read(const fbs::Advance& m) {
  return {phase(m.phase()), m.window(),      m.iteration(), finite(m.window_s(), "window_s"),
          m.sub_cycles(),   fields(m.data())};
}
Result read(const fbs::Result& m) {
  if (m.residual()) finite(*m.residual(), "residual");
  if (m.largest_step_s()) finite(*m.largest_step_s(), "largest_step_s");
  return {phase(m.phase()), m.window(),  m.iteration(), finite(m.compute_s(), "compute_s"),
          fields(m.data()), m.residual(), m.largest_step_s()};
}
Commit read(const fbs::Commit& m) {
  return {m.window()};
}
Rollback read(const fbs::Rollback& m) {
  return {m.window()};
}
Save read(const fbs::Save& m) {
  return {m.window(), text(m.path())};
}
Saved read(const fbs::Saved& m) {
  return {m.window(), m.hash()};
}
Restore read(const fbs::Restore& m) {
  return {m.window(), text(m.path()), m.hash()};
}
Restored read(const fbs::Restored& m) {
  return {m.window()};
}
Heartbeat read(const fbs::Heartbeat& m) {
  return {m.window(), m.progress()};
}
Fault read(const fbs::Fault& m) {
  return {m.code(), text(m.text())};
}
Finish read(const fbs::FinishRun&) {
  return {};
}
Bye read(const fbs::Bye& m) {
  return {facts(m.facts())};
}

Body read_body(const fbs::Message& m) {
  switch (m.body_type()) {
    case fbs::Body::Hello:
      return read(*m.body_as_Hello());
    case fbs::Body::Welcome:
      return read(*m.body_as_Welcome());
    case fbs::Body::Reject:
      return read(*m.body_as_Reject());
    case fbs::Body::Interface:
      return read(*m.body_as_Interface());
    case fbs::Body::Configure:
      return read(*m.body_as_Configure());
    case fbs::Body::Configured:
      return read(*m.body_as_Configured());
    case fbs::Body::Start:
      return read(*m.body_as_Start());
    case fbs::Body::Advance:
      return read(*m.body_as_Advance());
    case fbs::Body::Result:
      return read(*m.body_as_Result());
    case fbs::Body::Commit:
      return read(*m.body_as_Commit());
    case fbs::Body::Rollback:
      return read(*m.body_as_Rollback());
    case fbs::Body::Save:
      return read(*m.body_as_Save());
    case fbs::Body::Saved:
      return read(*m.body_as_Saved());
    case fbs::Body::Restore:
      return read(*m.body_as_Restore());
    case fbs::Body::Restored:
      return read(*m.body_as_Restored());
    case fbs::Body::Heartbeat:
      return read(*m.body_as_Heartbeat());
    case fbs::Body::Fault:
      return read(*m.body_as_Fault());
    case fbs::Body::Finish:
      return read(*m.body_as_Finish());
    case fbs::Body::Bye:
      return read(*m.body_as_Bye());
    case fbs::Body::NONE:
      break;
  }
  refuse("unknown body type " + std::to_string(static_cast<int>(m.body_type())));
}

}  // namespace

std::uint64_t schema_hash() {
  return XXH3_64bits(schema_text, sizeof schema_text - 1);
}

Message decode(Span<const std::uint8_t> frame) {
  const auto payload = open_frame(frame);
  flatbuffers::Verifier::Options limits;
  limits.max_depth = 8;
  limits.max_tables = 4096;
  flatbuffers::Verifier verifier(payload.data(), payload.size(), limits);
  if (!fbs::VerifyMessageBuffer(verifier)) refuse("it does not follow the schema");
  const auto& message = *fbs::GetMessage(payload.data());
  return {message.session(), message.sequence(), message.in_reply_to(), read_body(message)};
}

}  // namespace proto
