#include "coupler/record/frame_log.hpp"

#include <string.h>
#include <xxhash.h>

#include <cerrno>

#include "proto/error.hpp"

namespace coupler {
namespace {

constexpr char magic[8] = {'Q', 'F', 'L', 'O', 'G', '1', 0, 0};
constexpr std::size_t head_bytes = 6;
constexpr std::uint32_t largest_frame = 64u << 20;

}  // namespace

FrameLog::FrameLog(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wbx")) {
  if (!file_ || std::fwrite(magic, sizeof magic, 1, file_.get()) != 1)
    throw proto::Error(proto::ExitCode::cannot_create, strerror(errno), path);
}

void FrameLog::add(const std::string& participant, bool sent, proto::Span<const std::uint8_t> frame) {
  const auto size = static_cast<std::uint32_t>(frame.size());
  std::vector<std::uint8_t> entry(head_bytes + participant.size() + size + sizeof chain_);
  memcpy(entry.data(), &size, sizeof size);
  entry[4] = sent;
  entry[5] = static_cast<std::uint8_t>(participant.size());
  memcpy(entry.data() + head_bytes, participant.data(), participant.size());
  memcpy(entry.data() + head_bytes + participant.size(), frame.data(), size);
  chain_ = XXH3_64bits_withSeed(entry.data(), entry.size() - sizeof chain_, chain_);
  memcpy(entry.data() + entry.size() - sizeof chain_, &chain_, sizeof chain_);
  if (std::fwrite(entry.data(), entry.size(), 1, file_.get()) != 1)
    throw proto::Error(proto::ExitCode::io_error, strerror(errno), path_);
}

void FrameLog::close() {
  if (std::fclose(file_.release()) != 0) throw proto::Error(proto::ExitCode::io_error, strerror(errno), path_);
}

FrameLogReader::FrameLogReader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_)
    throw proto::Error(proto::ExitCode::missing_input, "there is no record of the run's frames", path,
                       "run the case with --record");
  char found[sizeof magic] = {};
  file_.read(found, sizeof found);
  if (memcmp(found, magic, sizeof magic) != 0)
    throw proto::Error(proto::ExitCode::bad_data, "this is no record of frames", path);
}

std::optional<LoggedFrame> FrameLogReader::next() {
  std::uint8_t head[head_bytes];
  if (!file_.read(reinterpret_cast<char*>(head), head_bytes)) return std::nullopt;
  std::uint32_t size = 0;
  memcpy(&size, head, sizeof size);
  const auto broken = [&](const char* how) {
    throw proto::Error(proto::ExitCode::bad_data,
                       "the record of frames " + std::string(how) + " at frame " + std::to_string(n_frames_), path_,
                       "run the case again");
  };
  if (size > largest_frame) broken("is damaged");
  const std::size_t name_size = head[5];
  std::vector<std::uint8_t> entry(head, head + head_bytes);
  entry.resize(head_bytes + name_size + size);
  std::uint64_t chain = 0;
  file_.read(reinterpret_cast<char*>(entry.data() + head_bytes), static_cast<std::streamsize>(name_size + size));
  if (!file_.read(reinterpret_cast<char*>(&chain), sizeof chain)) return std::nullopt;
  chain_ = XXH3_64bits_withSeed(entry.data(), entry.size(), chain_);
  if (chain != chain_) broken("was altered");
  ++n_frames_;
  const auto name = entry.begin() + head_bytes;
  const auto frame = name + static_cast<std::ptrdiff_t>(name_size);
  return LoggedFrame{{name, frame}, head[4] != 0, {frame, entry.end()}};
}

}  // namespace coupler
