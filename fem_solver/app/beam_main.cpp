// fem_beam: the rail as a Timoshenko beam and the wheel, as a participant of a coupled run or alone.
#include "fem_solver/app/command_line.hpp"
#include "fem_solver/beam/beam_rail.hpp"

int main(int argc, char** argv) {
  return fem::fem_program(
      argc, argv,
      {"fem_beam", "Rail and wheel of a ballasted track (Timoshenko beam).", fem::build_beam_rail, fem::mass_wheel});
}
