#include "pictures.hpp"

#include <dem/report/plot.hpp>

#include "humvee.hpp"

namespace hard_ground {

void draw(const Car& car, const std::string& folder, const std::string& scene) {
  const auto series = [&](const std::string& column, const std::string& name) {
    std::size_t at = 0;
    while (car.columns[at] != column) ++at;
    dem::io::Series s{.name = name};
    for (const auto& row : car.rows) {
      s.x.push_back(row[0]);
      s.y.push_back(row[at]);
    }
    return s;
  };
  dem::io::render_plot({.title = "Humvee, " + scene,
                        .x_label = "time [s]",
                        .y_label = "speed [m/s]",
                        .series = {series("speed_m_per_s", "speed")}},
                       folder + "/" + scene + "_speed");
  dem::io::Plot loads{.title = "Humvee, " + scene, .x_label = "time [s]", .y_label = "load of a wheel [N]"};
  dem::io::Plot travel{.title = "Humvee, " + scene, .x_label = "time [s]", .y_label = "travel of a wheel [m]"};
  for (const char* corner : {"fl", "fr", "rl", "rr"}) {
    loads.series.push_back(series(std::string(corner) + "_load_N", corner));
    travel.series.push_back(series(std::string(corner) + "_travel_m", corner));
  }
  dem::io::render_plot(loads, folder + "/" + scene + "_loads");
  dem::io::render_plot(travel, folder + "/" + scene + "_travel");
}

}  // namespace hard_ground
