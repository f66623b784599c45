#include "coupler/app/kit.hpp"

namespace coupler {

void add_kit_commands(CLI::App& app, Action& chosen) {
  add_init_command(app, chosen);
  add_graph_command(app, chosen);
  add_watch_command(app, chosen);
  add_conformance_command(app, chosen);
  add_replay_command(app, chosen);
  add_profile_command(app, chosen);
  add_keys_command(app, chosen);
  add_schema_command(app, chosen);
  add_slurm_command(app, chosen);
}

}  // namespace coupler
