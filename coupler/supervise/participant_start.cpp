#include "coupler/supervise/participant_start.hpp"

namespace coupler {

Patience patience_of(const proto::Coupling& coupling) {
  Patience patience;
  patience.connect_s = coupling.connect_timeout_s;
  patience.stall_s = patience.farewell_s = coupling.stall_timeout_s;
  return patience;
}

ChildSpec participant_process(const proto::ParticipantSpec& spec, const std::string& case_path,
                              const proto::CouplerEndpoint& endpoint, const std::string& folder) {
  ChildSpec child{spec.name,
                  spec.command,
                  {{"QDEM_FEM_SESSION_TOKEN", endpoint.session_token()}},
                  folder + "/" + spec.name + ".log"};
  const std::vector<std::string> options{"--case", case_path, "--endpoint", endpoint.address(),
                                         "--out",  folder,    "--name",     spec.name};
  child.command.insert(child.command.end(), options.begin(), options.end());
  return child;
}

void set_pad(proto::Configure& request, const std::vector<proto::PadLaw>& laws) {
  for (const auto& law : laws) {
    request.stiffness.push_back(law.stiffness);
    request.damping.push_back(law.damping);
    request.preload.push_back(law.preload);
    request.tension_cutoff.push_back(law.tension_cutoff);
  }
}

}  // namespace coupler
