#include "coupler/scheme/iqn_ils.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace coupler {
namespace {

constexpr std::size_t most_columns = 20;
constexpr double stalled_step = 1e-6;  // of the residual

using Vector = Eigen::VectorXd;
using Map = Eigen::Map<const Vector>;

Map map(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

void drop_column(AccelerationState& memory, std::size_t column) {
  std::size_t first = 0, window = 0;
  while (first + memory.columns_of_window[window] <= column) first += memory.columns_of_window[window++];
  --memory.columns_of_window[window];
  memory.columns.erase(memory.columns.begin() + static_cast<std::ptrdiff_t>(column));
}

void drop_oldest_half(AccelerationState& memory) {
  for (std::size_t n = (memory.columns.size() + 1) / 2; n > 0; --n) drop_column(memory, memory.columns.size() - 1);
}

}  // namespace

void IqnIls::learn(AccelerationState& memory, const std::vector<double>& residual, const std::vector<double>& image) {
  if (memory.columns_of_window.empty()) memory.columns_of_window.push_front(0);
  if (!memory.residual.empty()) {
    SecantColumn column{residual, image};
    for (std::size_t i = 0; i < residual.size(); ++i)
      column.residual[i] -= memory.residual[i], column.image[i] -= memory.image[i];
    memory.columns.push_front(std::move(column));
    ++memory.columns_of_window.front();
  }
  memory.residual = residual;
  memory.image = image;
}

void IqnIls::filter(AccelerationState& memory) const {
  std::vector<Vector> basis;
  for (std::size_t j = 0; j < memory.columns.size();) {
    const Map column = map(memory.columns[j].residual);
    const std::size_t room = std::min(memory.columns[j].residual.size(), most_columns);
    Vector fresh = column;
    for (const auto& q : basis) fresh -= q.dot(fresh) * q;
    if (basis.size() >= room || !(fresh.norm() > settings_.filter * column.norm())) {
      drop_column(memory, j);
      continue;
    }
    basis.push_back(fresh.normalized());
    ++j;
  }
}

std::vector<double> IqnIls::next(AccelerationState& memory, const std::vector<double>& iterate,
                                 const std::vector<double>& image) const {
  const auto residual = residual_of(iterate, image);
  learn(memory, residual, image);
  filter(memory);
  if (memory.columns.empty()) return relaxed(iterate, image, settings_.relaxation);
  const auto n = static_cast<Eigen::Index>(residual.size()), m = static_cast<Eigen::Index>(memory.columns.size());
  Eigen::MatrixXd v(n, m), w(n, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    v.col(j) = map(memory.columns[static_cast<std::size_t>(j)].residual);
    w.col(j) = map(memory.columns[static_cast<std::size_t>(j)].image);
  }
  const Vector c = v.householderQr().solve(-map(residual));
  const Vector next = map(image) + w * c;
  if (!((next - map(iterate)).norm() > stalled_step * map(residual).norm())) {
    drop_oldest_half(memory);
    return relaxed(iterate, image, settings_.relaxation);
  }
  return {next.data(), next.data() + n};
}

void IqnIls::end_window(AccelerationState& memory, const std::vector<double>& iterate,
                        const std::vector<double>& image) const {
  learn(memory, residual_of(iterate, image), image);
  filter(memory);
  memory.residual.clear();
  memory.image.clear();
  memory.columns_of_window.push_front(0);
  while (memory.columns_of_window.size() > static_cast<std::size_t>(settings_.reused_windows) + 1) {
    for (std::size_t n = memory.columns_of_window.back(); n > 0; --n) memory.columns.pop_back();
    memory.columns_of_window.pop_back();
  }
}

}  // namespace coupler
