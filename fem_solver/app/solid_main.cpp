// fem_solver: a rail of solid elements and the wheel, as a participant of a coupled run or alone.
#include "fem_solver/app/command_line.hpp"
#include "fem_solver/contact/block_contact.hpp"
#include "fem_solver/rail/solid_rail.hpp"
#include "fem_solver/wheel/solid_wheel.hpp"

int main(int argc, char** argv) {
  return fem::fem_program(argc, argv,
                          {"fem_solver", "Rail and wheel of a ballasted track (solid finite elements).",
                           fem::build_solid_rail, fem::build_wheel, fem::analyse_block_contact});
}
