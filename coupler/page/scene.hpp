// The 3-D view of a run: what of its fields a page of limited size can hold.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace coupler::page {

/// {"parts": [geometry with frames and histories], "frames": time [s] of each frame, "history_time" [s],
/// "outputs": steps of the run}, of qdem.h5 and fem.h5 in `folder`, in at
/// most `n_characters` of JSON. Outputs are left out evenly until it fits; the histories of bodies take a quarter at
/// most. {"note": why} where there is nothing to show or not even two frames fit.
/// Throws proto::Error (bad_data) for a damaged file.
nlohmann::json scene_json(const std::string& folder, std::size_t n_characters);

}  // namespace coupler::page
