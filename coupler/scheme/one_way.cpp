#include "coupler/scheme/one_way.hpp"

namespace coupler {

void OneWayScheme::solve(WindowRecord& record, Sides sides) {
  const std::vector<double> zero(n_values(), 0.0);
  solve_rail(record, robin_request(record, 0, {zero, zero, zero}), sides.implicit_side);
  solve_sleeper(record, path_request(record, 0), sides.explicit_side);
}

std::vector<proto::PadLaw> stand_in_laws(std::vector<proto::PadLaw> laws, const std::vector<double>& support) {
  for (std::size_t i = 0; i < support.size(); ++i) {
    const double share = support[i] / (laws[i].stiffness + support[i]);
    laws[i].stiffness *= share;
    laws[i].damping *= share * share;
  }
  return laws;
}

}  // namespace coupler
