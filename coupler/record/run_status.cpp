#include "coupler/record/run_status.hpp"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "proto/clock.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

using Json = nlohmann::ordered_json;

constexpr double interval_s = 1.0;

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();  // null: not finite
}

}  // namespace

std::string status_text(const RunStatus& s) {
  Json root{{"status", s.status},
            {"exit_code", s.exit_code},
            {"case", s.case_name},
            {"scheme", s.scheme},
            {"phase", s.phase},
            {"note", s.note},
            {"windows", s.n_windows},
            {"windows_wanted", s.n_windows_wanted},
            {"simulated_s", s.simulated_s},
            {"windows_per_s", s.windows_per_s},
            {"left_s", s.left_s},
            {"energy_defect_relative", s.energy_defect_relative},
            {"momentum_defect_relative", s.momentum_defect_relative},
            {"wall_s",
             {{"total", s.wall.total},
              {"start_up", s.wall.start_up},
              {"qdem", s.wall.qdem},
              {"fem", s.wall.fem},
              {"coupler", s.wall.coupler},
              {"waiting", s.wall.waiting}}},
            {"updated_s", std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count()}};
  Json seats = Json::array();
  for (const auto& seat : s.seats) seats.push_back({{"name", seat.name}, {"force_n", seat.force_n}});
  root["rail_seats"] = seats;
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunStatus read_status(const std::string& path) {
  std::ifstream file(path);
  if (!file)
    throw proto::Error(proto::ExitCode::missing_input, "there is no status of a run", path,
                       "name the output folder of a coupled run");
  try {
    const Json root = Json::parse(file);
    RunStatus s;
    s.status = root.at("status"), s.exit_code = root.at("exit_code");
    s.case_name = root.at("case"), s.scheme = root.at("scheme");
    s.phase = root.at("phase"), s.note = root.at("note");
    s.n_windows = root.at("windows"), s.n_windows_wanted = root.at("windows_wanted");
    s.simulated_s = number(root.at("simulated_s")), s.windows_per_s = number(root.at("windows_per_s"));
    s.left_s = number(root.at("left_s"));
    s.energy_defect_relative = number(root.at("energy_defect_relative"));
    s.momentum_defect_relative = number(root.at("momentum_defect_relative"));
    const Json& wall = root.at("wall_s");
    s.wall = {number(wall.at("total")), number(wall.at("start_up")), number(wall.at("qdem")),
              number(wall.at("fem")),   number(wall.at("waiting")),  number(wall.at("coupler"))};
    for (const Json& seat : root.at("rail_seats")) s.seats.push_back({seat.at("name"), number(seat.at("force_n"))});
    return s;
  } catch (const nlohmann::json::exception& error) {
    throw proto::Error(proto::ExitCode::bad_data, std::string("cannot be read as the status of a run: ") + error.what(),
                       path);
  }
}

void StatusFile::renew() {
  if (proto::seconds_since(written_) >= interval_s) write();
}

void StatusFile::write() {
  written_ = std::chrono::steady_clock::now();
  try {
    proto::replace_text_file(path_, status_text(now_));
  } catch (const proto::Error&) {
  }
}

}  // namespace coupler
