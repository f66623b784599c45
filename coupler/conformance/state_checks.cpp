// What the participant keeps: the same request from the same state has the same answer, to the bit.
#include <fmt/format.h>

#include <filesystem>

#include "coupler/conformance/check.hpp"
#include "coupler/conformance/subject.hpp"
#include "proto/wire/codec.hpp"

namespace coupler::conformance {
namespace {

/// "" when the windows from `first` on are those of the reference.
std::string departure(const std::vector<proto::Result>& found, const Reference& reference, std::size_t first) {
  for (std::size_t i = 0; i < found.size(); ++i)
    if (const auto text = difference(found[i], reference.windows[first + i]); !text.empty()) return text;
  return {};
}

Verdict repeatable(Bench& bench) {
  const auto& reference = bench.reference();
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  const auto text = departure(subject.march(static_cast<int>(reference.windows.size())), reference, 0);
  if (!text.empty()) return fail("a second run is another one: " + text);
  return pass(fmt::format("{} windows twice, the same bytes", reference.windows.size()));
}

Verdict repeated_request(Bench& bench) {
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  subject.march(1);
  const auto request = subject.request();
  const auto message = subject.next_message(request);
  const auto first = subject.solve(request);
  subject.send_bytes(proto::encode(message));
  const auto second = subject.await<proto::Result>(message.sequence);
  if (const auto text = difference(second, first); !text.empty())
    return fail("an Advance that arrives twice is answered differently: " + text);
  subject.commit();
  if (const auto text = departure(subject.march(1), bench.reference(), 2); !text.empty())
    return fail("an Advance that arrives twice is solved twice: " + text);
  return pass();
}

Verdict rollback(Bench& bench) {
  const auto& reference = bench.reference();
  if (!reference.capabilities.rollback) return not_offered("no rollback");
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  subject.march(2);
  subject.solve(subject.request());
  subject.rollback();
  if (const auto text = difference(subject.solve(subject.request()), reference.windows[2]); !text.empty())
    return fail("advance, rollback, advance: " + text);
  subject.rollback();
  subject.solve(subject.request(3.0));  // another way, which must leave no trace
  subject.rollback();
  if (const auto text = difference(subject.solve(subject.request()), reference.windows[2]); !text.empty())
    return fail("after another window was taken back: " + text);
  subject.commit();
  if (const auto text = departure(subject.march(2), reference, 3); !text.empty())
    return fail("in the windows after the rollback: " + text);
  return pass("three rollbacks, the same bytes in this window and the next");
}

/// A process that marches on after `saving`, in the folder of the one that saved.
std::vector<proto::Result> march_restored(Bench& bench, const Saving& saving, int n_windows) {
  Settings settings;
  settings.folder = saving.folder;
  Subject subject(bench, settings);
  subject.bring_to(Stage::configured);
  subject.restore(saving);
  return subject.march(n_windows);
}

Verdict save_restore(Bench& bench) {
  const auto& reference = bench.reference();
  if (!reference.capabilities.save_restore) return not_offered("no save and restore");
  Saving saving;
  {
    Subject subject(bench);
    subject.bring_to(Stage::marching);
    subject.march(3);
    saving = subject.save();
    if (!std::filesystem::exists(saving.path)) return fail("it wrote no file of the name it was given");
    if (const auto text = departure(subject.march(2), reference, 3); !text.empty())
      return fail("saving changed what followed: " + text);
  }
  if (const auto text = departure(march_restored(bench, saving, 3), reference, 3); !text.empty())
    return fail("a new process that was restored goes another way: " + text);
  auto changed = saving;
  changed.hash ^= 1;
  Settings settings;
  settings.folder = saving.folder;
  Subject subject(bench, settings);
  subject.bring_to(Stage::configured);
  subject.send(proto::Restore{changed.window, changed.path, changed.hash});
  const auto end = subject.ending(bench.candidate().coupling.stall_timeout_s);
  if (!end.exit || end.exit->signal || !end.fault) return fail("a file of another hash: " + end.text());
  return pass("a new process goes on with the same bytes; a file of another hash is refused");
}

}  // namespace

std::vector<Check> state_checks() {
  return {{"repeatable", "the same requests have the same answers in another process", Role::both, repeatable},
          {"repeated_request", "an Advance that arrives twice is solved once and answered twice", Role::both,
           repeated_request},
          {"rollback", "advance, rollback, advance gives the same bytes", Role::both, rollback},
          {"save_restore", "saved and restored into a new process it goes on with the same bytes", Role::both,
           save_restore}};
}

}  // namespace coupler::conformance
