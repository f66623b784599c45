// A force over time, as a case gives it.
#pragma once

#include <functional>

#include "proto/case/case_file.hpp"

namespace qdem {

/// Force [N] at a time [s].
using LoadHistory = std::function<double(double)>;

/// Reads a table such as [qdem.run.load]; an empty section is no load, and an empty function.
///     kind = "table"      time_s (ascending), force_n: linear between, constant outside
///     kind = "half_sine"  peak_n, duration_s, start_s (0): an impulse of 2/pi peak duration
///     kind = "cyclic"     mean_n, amplitude_n, frequency_hz, cycles; start_s (0): the mean is reached by then, and
///                         sine waves run about it; after the last cycle the force stays as it ends
/// Throws proto::Error (config).
LoadHistory read_load(const proto::Section& section);

}  // namespace qdem
