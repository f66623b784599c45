// A number that counts the arithmetic done with it, to know a kernel's work from its own code.
#pragma once

#include <cstdint>

namespace qdem::bench {

/// Work of a piece of code, with every product that is added to something fused into it, as compilers do.
struct Work {
  std::int64_t instructions = 0;  ///< floating-point, one for a fused multiply-add
  std::int64_t flops = 0;
};

/// Behaves like a double under +, -, *. Not for several threads.
class Counted {
 public:
  Counted() = default;
  Counted(double value) : value_(value) {}
  static Work& work() {
    static Work total;
    return total;
  }

  friend Counted operator*(const Counted& a, const Counted& b) {
    ++work().instructions, ++work().flops;
    return {a.value_ * b.value_, true};
  }
  friend Counted operator+(const Counted& a, const Counted& b) { return sum(a, b, a.value_ + b.value_); }
  friend Counted operator-(const Counted& a, const Counted& b) { return sum(a, b, a.value_ - b.value_); }
  Counted operator-() const { return {-value_, product_}; }

 private:
  Counted(double value, bool product) : value_(value), product_(product) {}
  static Counted sum(const Counted& a, const Counted& b, double value) {
    ++work().flops;
    if (!a.product_ && !b.product_) ++work().instructions;  // else fused into the product's own instruction
    return {value, false};
  }

  double value_ = 0.0;
  bool product_ = false;  ///< not added to anything yet
};

}  // namespace qdem::bench
