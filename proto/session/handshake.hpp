// Who may take part: the checks of a Hello.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/session/coupler_endpoint.hpp"
#include "proto/wire/messages.hpp"

namespace proto {

/// 128 random bits of the operating system as hexadecimal digits.
std::string random_token();
/// Random and not zero.
std::uint64_t random_session();

/// The reason to reject a Hello, both values named; empty if it is welcome. `taken`: names already in use.
std::string why_not_welcome(const Hello& hello, const Admission& admission, const std::string& token,
                            const std::vector<std::string>& taken);

}  // namespace proto
