#include "coupling_generated.h"
#include "proto/wire/codec.hpp"
#include "proto/wire/frame.hpp"

namespace proto {
namespace {

using flatbuffers::Offset;

/// Writes the body of a message; one overload a message type.
class BodyWriter {
 public:
  explicit BodyWriter(flatbuffers::FlatBufferBuilder& builder) : b_(builder) {}

  auto operator()(const Hello& m) {
    const auto& can = m.capabilities;
    const auto capabilities = fbs::CreateCapabilities(b_, can.robin, can.rollback, can.save_restore, can.initialise);
    return fbs::CreateHello(b_, text(m.name), m.protocol_major, m.protocol_minor, m.schema_hash, m.case_hash,
                            text(m.session_token), text(m.build_id), capabilities);
  }
  auto operator()(const Welcome& m) { return fbs::CreateWelcome(b_, m.session, m.heartbeat_s); }
  auto operator()(const Reject& m) { return fbs::CreateReject(b_, text(m.reason)); }
  auto operator()(const Interface& m) {
    std::vector<Offset<fbs::FieldSpec>> specs;
    for (const auto& spec : m.fields)
      specs.push_back(fbs::CreateFieldSpec(b_, text(spec.name), text(spec.unit), spec.components, spec.outgoing));
    std::vector<Offset<fbs::SeatRegistration>> seats;
    for (const auto& seat : m.seats) seats.push_back(write(seat));
    return fbs::CreateInterface(b_, b_.CreateVector(specs), b_.CreateVector(seats));
  }
  auto operator()(const Configure& m) {
    return fbs::CreateConfigure(b_, m.window_s, m.windows, static_cast<fbs::LoadMode>(m.mode), text(m.output_directory),
                                numbers(m.stiffness), numbers(m.damping), numbers(m.preload), flags(m.tension_cutoff),
                                m.pad_map.empty() ? 0 : numbers(m.pad_map));
  }
  auto operator()(const Configured& m) {
    return fbs::CreateConfigured(b_, m.largest_step_s, facts(m.facts), m.largest_initialise_step_s);
  }
  auto operator()(const Start&) { return fbs::CreateStart(b_); }
  auto operator()(const Advance& m) {
    return fbs::CreateAdvance(b_, phase(m.phase), m.window, m.iteration, m.window_s, m.sub_cycles, fields(m.data));
  }
  auto operator()(const Result& m) {
    return fbs::CreateResult(b_, phase(m.phase), m.window, m.iteration, m.compute_s, fields(m.data), m.residual,
                             m.largest_step_s);
  }
  auto operator()(const Commit& m) { return fbs::CreateCommit(b_, m.window); }
  auto operator()(const Rollback& m) { return fbs::CreateRollback(b_, m.window); }
  auto operator()(const Save& m) { return fbs::CreateSave(b_, m.window, text(m.path)); }
  auto operator()(const Saved& m) { return fbs::CreateSaved(b_, m.window, m.hash); }
  auto operator()(const Restore& m) { return fbs::CreateRestore(b_, m.window, text(m.path), m.hash); }
  auto operator()(const Restored& m) { return fbs::CreateRestored(b_, m.window); }
  auto operator()(const Heartbeat& m) { return fbs::CreateHeartbeat(b_, m.window, m.progress); }
  auto operator()(const Fault& m) { return fbs::CreateFault(b_, m.code, text(m.text)); }
  auto operator()(const Finish&) { return fbs::CreateFinishRun(b_); }
  auto operator()(const Bye& m) { return fbs::CreateBye(b_, facts(m.facts)); }

 private:
  Offset<flatbuffers::String> text(const std::string& value) { return b_.CreateString(value); }
  Offset<flatbuffers::Vector<double>> numbers(const std::vector<double>& values) { return b_.CreateVector(values); }
  Offset<flatbuffers::Vector<std::uint8_t>> flags(const std::vector<bool>& values) { return b_.CreateVector(values); }
  static fbs::Phase phase(Phase value) { return static_cast<fbs::Phase>(value); }

  Offset<flatbuffers::Vector<Offset<fbs::Field>>> fields(const FieldSet& set) {
    std::vector<Offset<fbs::Field>> written;
    for (const auto& field : set.all())
      written.push_back(fbs::CreateField(b_, text(field.name), numbers(field.values)));
    return b_.CreateVector(written);
  }

  Offset<flatbuffers::Vector<Offset<fbs::Fact>>> facts(const std::vector<Fact>& list) {
    std::vector<Offset<fbs::Fact>> written;
    for (const auto& fact : list) written.push_back(fbs::CreateFact(b_, text(fact.key), fact.number, text(fact.text)));
    return b_.CreateVector(written);
  }

  Offset<fbs::SeatRegistration> write(const SeatRegistration& seat) {
    return fbs::CreateSeatRegistration(b_, text(seat.name), numbers(seat.points), numbers(seat.weights),
                                       numbers(seat.rigid_response), numbers(seat.force_resultants),
                                       numbers(seat.stiffness), numbers(seat.damping), numbers(seat.preload),
                                       flags(seat.tension_cutoff), seat.own_points);
  }

  flatbuffers::FlatBufferBuilder& b_;
};

/// Size of the fields of a message: a builder that need not grow copies nothing twice.
std::size_t data_bytes(const Body& body) {
  const auto* advance = std::get_if<Advance>(&body);
  const auto* result = std::get_if<Result>(&body);
  std::size_t bytes = 0;
  if (advance || result)
    for (const auto& field : (advance ? advance->data : result->data).all())
      bytes += field.values.size() * sizeof(double) + 64;
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode(const Message& message) {
  flatbuffers::FlatBufferBuilder builder(1024 + data_bytes(message.body));
  BodyWriter write(builder);
  const Offset<void> body = std::visit([&](const auto& m) { return write(m).Union(); }, message.body);
  // The schema's union lists the bodies in the variant's order; its member 0 is "none".
  const auto type = static_cast<fbs::Body>(message.body.index() + 1);
  fbs::FinishMessageBuffer(
      builder, fbs::CreateMessage(builder, message.session, message.sequence, message.in_reply_to, type, body));
  return make_frame({builder.GetBufferPointer(), builder.GetSize()});
}

}  // namespace proto
