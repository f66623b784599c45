// What a program wrote last.
#pragma once

#include <string>

namespace coupler {

/// Last line of the file that is not blank, at most 400 characters of it; "" when there is none.
std::string last_words(const std::string& path);

}  // namespace coupler
