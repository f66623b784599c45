// `qdem_solver bench --cuda`: rates of the CUDA engine beside what the device could do.
#pragma once

#include <string>

#include "qdem_solver/bench/scenes.hpp"

namespace qdem::bench {

/// Bytes that a step of the device engine moves through memory for an element, contacts apart, if nothing stays in a
/// cache from one kernel to the next; engine/device/README.md lists them.
double device_bytes_per_element(const Scene& scene);

/// Measures, and says so in a table for people: steps and element updates a second of several scenes, and the share of
/// the device's memory rate. Throws proto::Error (unavailable) without a device.
std::string device_table();

}  // namespace qdem::bench
