#include "tyres.hpp"

#include <dem/io/csv.hpp>
#include <dem/report/plot.hpp>
#include <dem/vehicle/tyre_press.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace hard_ground {

using dem::vehicle::RingTyreSpec;

void press_tyres(const std::string& folder) {
  const std::vector<double> pressures = {1.0e5, 1.7e5, 2.5e5, 3.4e5};
  // kN at each deflection, of the tyre (37 x 12.5 R 16.5) of Project Chrono's public HMMWV model,
  // data/vehicle/hmmwv/tire: curves of HMMWV_FialaTire.json and of HMMWV_Pac89Tire.json. Neither says at which
  // pressure.
  const std::vector<std::pair<const char*, std::vector<double>>> published = {
      {"Chrono, Fiala", {1.286, 3.477, 6.190, 9.027, 12.139, 15.368, 18.469, 21.699}},
      {"Chrono, Pac89", {2.830, 6.212, 10.146, 14.632, 19.670, 25.260, 31.402, 38.096}}};
  std::vector<double> deflections;
  for (int k = 1; k <= 8; ++k) deflections.push_back(0.01 * k);

  std::vector<std::string> columns = {"deflection_m"};
  std::vector<std::vector<double>> rows;
  for (const double d : deflections) rows.push_back({d});
  dem::io::Plot plot{.title = "A tyre of the Humvee on a plate", .x_label = "deflection [mm]", .y_label = "load [kN]"};
  fmt::print("\ntyres: load (kN) on a plate, length of the belt that touches (mm)\n  deflection (mm)");
  for (const double d : deflections) fmt::print("{:>12.0f}", 1e3 * d);
  for (const double pressure : pressures) {
    const RingTyreSpec spec{.pressure = pressure};
    dem::vehicle::TyrePress press(spec);
    const std::string name = fmt::format("{:g} bar", 1e-5 * pressure);
    dem::io::Series curve{.name = name};
    columns.push_back(fmt::format("load_{:g}_Pa_N", pressure));
    columns.push_back(fmt::format("length_{:g}_Pa_m", pressure));
    fmt::print("\n  {:<15}", name);
    for (std::size_t k = 0; k < deflections.size(); ++k) {
      const auto load = press.at(deflections[k]);
      rows[k].push_back(load.force), rows[k].push_back(load.length);
      curve.x.push_back(1e3 * deflections[k]), curve.y.push_back(1e-3 * load.force);
      fmt::print("{:>12}", fmt::format("{:.1f}, {:.0f}", 1e-3 * load.force, 1e3 * load.length));
    }
    plot.series.push_back(curve);
    fmt::print("  Rhyne: {:.0f} kN/m",
               1e-3 * dem::vehicle::rhyne_stiffness(pressure, spec.width, spec.radius, spec.rim_radius));
  }
  for (const auto& [name, loads] : published) {
    dem::io::Series curve{.name = name};
    fmt::print("\n  {:<15}", name);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      curve.x.push_back(1e3 * deflections[k]), curve.y.push_back(loads[k]);
      fmt::print("{:>12.1f}", loads[k]);
    }
    plot.series.push_back(curve);
  }
  fmt::print("\n");
  dem::io::CsvWriter csv(folder + "/tyres.csv", columns);
  for (const auto& row : rows) csv.row(row);
  csv.flush();
  dem::io::render_plot(plot, folder + "/tyres_load");
}

}  // namespace hard_ground
