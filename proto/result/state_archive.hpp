// What a restart needs of a state, named once: the same calls save it and read it back.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace proto {

/// Either takes the values down (state_file.hpp: StateWriter) or fills them (StateReader). A class with a state lists
/// its members in one function that works both ways:
///
///     void exchange(StateArchive& archive) { archive("displacement", u_); archive("window", window_); }
///
/// Names are paths; each is given once. Everything comes back to the bit. Throws proto::Error: bad_data when a
/// value is missing or does not fit.
class StateArchive {
 public:
  virtual ~StateArchive() = default;
  /// Whether values are filled in from a file.
  virtual bool restoring() const = 0;

  virtual void operator()(const std::string& name, std::vector<double>& values) = 0;
  virtual void operator()(const std::string& name, std::vector<std::int64_t>& values) = 0;

  void operator()(const std::string& name, double& value) { through<std::vector<double>>(name, value); }
  void operator()(const std::string& name, std::string& text);
  void operator()(const std::string& name, Eigen::VectorXd& values);
  void operator()(const std::string& name, std::vector<Eigen::Vector3d>& values);
  void operator()(const std::string& name, std::vector<int>& values);
  template <class Whole>
  std::enable_if_t<std::is_integral_v<Whole>> operator()(const std::string& name, Whole& value) {
    auto number = static_cast<std::int64_t>(value);
    through<std::vector<std::int64_t>>(name, number);
    value = static_cast<Whole>(number);
  }

  /// Something that the state fits to and that is not part of it: a hash, a size in words. Throws (bad_data) when the
  /// file was made with another; `what` names it: "the bed".
  void expect_same(const std::string& name, const std::string& what, const std::string& mine);
  /// Throws (bad_data) unless `found` values are as many as `wanted`.
  void expect_length(const std::string& name, std::size_t found, std::size_t wanted) const;

 private:
  [[noreturn]] virtual void refuse(const std::string& name, const std::string& problem) const = 0;
  template <class List, class Value>
  void through(const std::string& name, Value& value) {
    List list{value};
    (*this)(name, list);
    expect_length(name, list.size(), 1);
    value = list.front();
  }
};

}  // namespace proto
