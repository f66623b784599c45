// Reads one case file after the other with the readers of the programs, for tests with thousands of them. A line
// "SECTION PATH" on stdin is answered by "CODE MESSAGE" on stdout: 0 when the readers of that section take the case.
#include <cstdio>
#include <iostream>
#include <string>

#include "fem_solver/model/settings.hpp"
#include "proto/case/coupling.hpp"
#include "proto/error.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/participant/qdem_case.hpp"

namespace {

void read(const std::string& section, const std::string& path) {
  const auto file = proto::CaseFile::load(path);
  if (section == "coupling") {
    proto::read_coupling(file);
  } else if (section == "rail_seat") {
    proto::read_rail_seats(file);
  } else if (section == "bed" || section == "qdem") {
    qdem::read_qdem_case(file);
    qdem::bed::read_settings(file);
  } else {
    fem::read_wheel(file, fem::read_fem(file, proto::read_rail_seats(file)).material);
  }
}

}  // namespace

int main() {
  for (std::string section, path; std::cin >> section >> path;) {
    try {
      read(section, path);
      std::cout << "0" << std::endl;
    } catch (const proto::Error& error) {
      std::cout << static_cast<int>(error.code()) << " " << error.what() << std::endl;
    }
  }
}
