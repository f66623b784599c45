// frames.log: every frame that the coupler and its participants exchanged after the handshake, in a file that only
// grows.
//
// Layout, little endian: "QFLOG1\0\0", then per frame
//     u32 size of the frame | u8 1: to the participant, 0: from it | u8 length of its name | name | frame | u64 chain
// The chain is XXH3-64 of all the entry's bytes before it, with the chain of the entry before as its seed (0 at first):
// an entry that was altered, taken out or put in breaks it. A torn last entry is what a killed run leaves.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/span.hpp"

namespace coupler {

class FrameLog {
 public:
  /// Throws proto::Error (cannot_create), also when the file is there already.
  explicit FrameLog(const std::string& path);
  /// Throws proto::Error (io_error).
  void add(const std::string& participant, bool sent, proto::Span<const std::uint8_t> frame);
  /// Ends the log; nothing may follow. Throws proto::Error (io_error) when its end cannot be written.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t chain_ = 0;
};

struct LoggedFrame {
  std::string participant;
  bool sent = false;  ///< to the participant
  std::vector<std::uint8_t> bytes;
};

class FrameLogReader {
 public:
  /// Throws proto::Error: missing_input, bad_data (no such log).
  explicit FrameLogReader(const std::string& path);
  /// The next frame; nothing at the end and at a torn last entry. Throws proto::Error (bad_data) where the chain
  /// breaks.
  std::optional<LoggedFrame> next();

 private:
  std::string path_;
  std::ifstream file_;
  std::uint64_t chain_ = 0, n_frames_ = 0;
};

}  // namespace coupler
