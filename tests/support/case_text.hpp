// A case file written by a test.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"

namespace tests {

/// `text` as case.toml in a folder of its own, removed at the end.
class CaseText {
 public:
  explicit CaseText(const std::string& text) {
    char name[] = "/tmp/qf-case-XXXXXX";
    folder_ = mkdtemp(name);
    std::ofstream(path()) << text;
  }
  ~CaseText() { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ + "/case.toml"; }
  std::string folder() const { return folder_; }
  proto::CaseFile load() const { return proto::CaseFile::load(path()); }

 private:
  std::string folder_;
};

/// Text of the proto::Error that `action` throws, its folder cut off; "no error" otherwise. `code` gets its code.
template <class Action>
std::string error_of(Action action, proto::ExitCode* code = nullptr) {
  try {
    action();
  } catch (const proto::Error& error) {
    if (code) *code = error.code();
    std::string text = error.what();
    for (auto at = text.find("/tmp/qf-case-"); at != std::string::npos; at = text.find("/tmp/qf-case-"))
      text.erase(at, std::string("/tmp/qf-case-XXXXXX/").size());
    return text;
  }
  return "no error";
}

}  // namespace tests
