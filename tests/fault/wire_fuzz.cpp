// The decoder against damaged frames of a real run. Without a right hash none passes; with the hash made right again
// what is decoded is whole: finite, and the same once more when it is sent on. Built with sanitizers (tests/run --asan)
// it also shows that no byte outside of the frame is touched. HOUSE_FUZZ=N takes N variants instead of 200 000;
// HOUSE_SEEDS=DIR writes the payloads for decoder_fuzzer.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>

#include "coupler/record/frame_log.hpp"
#include "proto/error.hpp"
#include "proto/wire/codec.hpp"
#include "proto/wire/frame.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/frame_mutations.hpp"
#include "tests/support/sample_messages.hpp"

namespace {

using proto::ExitCode;
using tests::Payload;

/// Every frame of a short run, and one of each message that it lacks.
std::vector<Payload> seeds() {
  tests::OscillatorCase variant;
  variant.duration_s = 0.25;
  tests::CoupledRun run(variant.text());
  const auto code = run.run({"run", run.case_path(), "--out", run.out(), "--record"});
  EXPECT_EQ(code.value_or(-1), 0) << run.message();
  std::vector<Payload> payloads;
  coupler::FrameLogReader log(run.out() + "/frames.log");
  while (const auto frame = log.next())
    payloads.emplace_back(frame->bytes.begin() + proto::frame_prefix_bytes, frame->bytes.end());
  EXPECT_GT(payloads.size(), 60u);
  for (const auto& message : tests::sample_messages()) payloads.push_back(proto::open_frame(proto::encode(message)));
  return payloads;
}

/// The message, or nothing where it was refused as it should be.
std::optional<proto::Message> decoded(const std::vector<std::uint8_t>& frame) {
  try {
    return proto::decode(frame);
  } catch (const proto::Error& error) {
    EXPECT_TRUE(error.code() == ExitCode::protocol || error.code() == ExitCode::numerics) << error.what();
    return {};
  }
}

class WireFuzz : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { seeds_ = new std::vector<Payload>(seeds()); }
  static void TearDownTestSuite() { delete seeds_; }
  static std::vector<Payload>* seeds_;
};

std::vector<Payload>* WireFuzz::seeds_ = nullptr;

TEST_F(WireFuzz, no_flipped_bit_passes_and_no_wrong_length) {
  std::size_t n_flips = 0;
  for (std::size_t i = 0; i < seeds_->size(); i += 5) {
    auto frame = proto::make_frame((*seeds_)[i]);
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit, ++n_flips) {
      frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
      ASSERT_FALSE(decoded(frame)) << "bit " << bit << " of frame " << i;
      frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    }
    for (std::size_t size = 0; size < frame.size(); ++size)
      ASSERT_FALSE(decoded({frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
    for (int n = 1; n <= 64; ++n) {
      frame.push_back(static_cast<std::uint8_t>(n));
      ASSERT_FALSE(decoded(frame)) << n << " more";
    }
  }
  EXPECT_GT(n_flips, 10000u);
}

TEST_F(WireFuzz, what_is_decoded_of_damaged_payloads_is_whole) {
  if (const char* folder = std::getenv("HOUSE_SEEDS"))
    for (std::size_t i = 0; i < seeds_->size(); ++i)
      std::ofstream(std::string(folder) + "/" + std::to_string(i), std::ios::binary)
          .write(reinterpret_cast<const char*>((*seeds_)[i].data()), static_cast<std::streamsize>((*seeds_)[i].size()));
  const char* wanted = std::getenv("HOUSE_FUZZ");
  const long n = wanted ? std::atol(wanted) : 200000;
  tests::FrameMutator mutator(*seeds_, 1);
  long n_accepted = 0;
  std::chrono::steady_clock::duration longest{};
  for (long i = 0; i < n; ++i) {
    const auto frame = proto::make_frame(mutator.next());
    const auto begin = std::chrono::steady_clock::now();
    const auto message = decoded(frame);
    longest = std::max(longest, std::chrono::steady_clock::now() - begin);
    if (!message) continue;
    ++n_accepted;
    ASSERT_TRUE(proto::decode(proto::encode(*message)) == *message) << "variant " << i;
  }
  // Both ways have to be gone often, or the variants show nothing.
  EXPECT_GT(n_accepted, n / 20);
  EXPECT_LT(n_accepted, n - n / 20);
  EXPECT_LT(std::chrono::duration<double>(longest).count(), 1.0);
  std::printf("%ld variants, %ld decoded, the longest took %.1e s\n", n, n_accepted,
              std::chrono::duration<double>(longest).count());
}

}  // namespace
