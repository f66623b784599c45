#include "coupler/app/drawing.hpp"

#include <fmt/format.h>

#include "coupler/launch/children.hpp"
#include "coupler/launch/program_path.hpp"
#include "proto/error.hpp"

namespace coupler {

void draw(const std::string& program, const std::vector<std::string>& arguments, const std::string& script,
          const std::string& picture) {
  try {
    ChildSpec spec{program, {find_program(program, "PATH")}, {}, script + ".log"};
    spec.command.insert(spec.command.end(), arguments.begin(), arguments.end());
    Children children(own_path());
    children.start(spec);
    while (!children.exit_of(program)) children.wait(0.1);
    const auto exit = *children.exit_of(program);
    if (exit.code == 0 && exit.signal == 0)
      fmt::print("picture in {}\n", picture);
    else
      fmt::print("{} {}: see {}.log\n", program, exit.text(), script);
  } catch (const proto::Error&) {
    fmt::print("no picture: {} is not installed; what it would draw is in {}\n", program, script);
  }
}

}  // namespace coupler
