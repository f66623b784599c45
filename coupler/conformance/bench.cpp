#include "coupler/conformance/bench.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "coupler/conformance/subject.hpp"
#include "proto/error.hpp"

namespace coupler::conformance {

std::string Bench::new_folder() {
  const auto path = fmt::format("{}/{:03d}", folder_, ++n_folders_);
  std::error_code error;
  if (!std::filesystem::create_directory(path, error))
    throw proto::Error(proto::ExitCode::cannot_create, error.message(), path);
  return path;
}

const Reference& Bench::reference() {
  if (!reference_) {
    Subject subject(*this);
    subject.bring_to(Stage::marching);
    reference_ = Reference{subject.hello().capabilities, subject.initial(), {}};
    reference_->windows = subject.march(6);
  }
  return *reference_;
}

}  // namespace coupler::conformance
