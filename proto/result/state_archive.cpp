#include "proto/result/state_archive.hpp"

namespace proto {

void StateArchive::operator()(const std::string& name, std::string& text) {
  std::vector<std::int64_t> bytes(text.begin(), text.end());
  (*this)(name, bytes);
  text.assign(bytes.begin(), bytes.end());
}

void StateArchive::operator()(const std::string& name, Eigen::VectorXd& values) {
  std::vector<double> list(values.data(), values.data() + values.size());
  (*this)(name, list);
  values = Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

void StateArchive::operator()(const std::string& name, std::vector<Eigen::Vector3d>& values) {
  std::vector<double> list;
  list.reserve(3 * values.size());
  for (const auto& value : values) list.insert(list.end(), value.data(), value.data() + 3);
  (*this)(name, list);
  expect_length(name, list.size() % 3, 0);
  values.resize(list.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = Eigen::Map<const Eigen::Vector3d>(&list[3 * i]);
}

void StateArchive::operator()(const std::string& name, std::vector<int>& values) {
  std::vector<std::int64_t> list(values.begin(), values.end());
  (*this)(name, list);
  values.assign(list.begin(), list.end());
}

void StateArchive::expect_same(const std::string& name, const std::string& what, const std::string& mine) {
  std::string other = mine;
  (*this)(name, other);
  if (other != mine) refuse(name, "it belongs to another state of " + what + ": " + other + ", here " + mine);
}

void StateArchive::expect_length(const std::string& name, std::size_t found, std::size_t wanted) const {
  if (found != wanted) refuse(name, std::to_string(found) + " values instead of " + std::to_string(wanted));
}

}  // namespace proto
