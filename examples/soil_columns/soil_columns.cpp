// A rigid wheel on soil columns (dynamic Bekker): pull, torque and sinkage over slip, beside the semi-empirical curves
// of the same soil, and the rut that it leaves.
//
//   soil_columns --load 130 --soil sand.toml --output out/soil_columns
//   soil_columns --wheel grousers --grouser 0.01        also smooth; rough is the default
//   soil_columns --radius 0.3 --width 0.2 --load 800 --slips=-0.2,0,0.2
//   soil_columns --halve                                how much the results change with columns half as wide
//
// prints a table, and writes it as CSV, plots, and the last rut as CSV, PGM picture and ParaView surface. A slip at
// which the soil does not carry the wheel has a gap.

#include <dem/io/csv.hpp>
#include <dem/io/file.hpp>
#include <dem/report/ascii_table.hpp>
#include <dem/report/plot.hpp>
#include <dem/rig/launcher.hpp>
#include <dem/rig/number.hpp>
#include <dem/terramechanics/column_wheel.hpp>
#include <dem/terramechanics/rut_files.hpp>
#include <dem/terramechanics/rut_vtk.hpp>
#include <dem/terramechanics/soil_reader.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

using namespace dem;
using namespace dem::terramechanics;

int main(int argc, char** argv) {
  ColumnWheel s{.travel = 0.0};
  NamedSoil named = {"sand P1", "D. Melanz", melanz_sand};
  std::string soil, output = "soil_columns_output", kind = "rough";
  std::vector<double> slips = {-0.7, -0.5, -0.3, -0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7};
  double spin = 17.0;  // deg/s
  double grouser = 0.01, friction = 0.3;
  bool halve = false;
  CLI::App app("A rigid wheel on soil columns, beside the semi-empirical curves");
  app.add_option("--soil", soil,
                 "dry-sand, sandy-loam, lete-sand, clayey, snow, hard, p1 or p3, or the file of a soil; without, p1");
  app.add_option("--wheel", kind, "rough (soil shears on soil), smooth or grousers")
      ->capture_default_str()
      ->check(CLI::IsMember({"rough", "smooth", "grousers"}));
  const auto* grouser_option =
      app.add_option("--grouser", grouser, "height of grousers [m], 0.001 to 0.1")->capture_default_str();
  const auto* friction_option =
      app.add_option("--friction", friction, "mu of a smooth rim on the soil, 0 to 2")->capture_default_str();
  app.add_flag("--halve", halve, "the same on columns half as wide, and how much that changes");
  app.add_option("--radius", s.wheel.radius, "of the wheel without grousers [m], 0.05 to 2")->capture_default_str();
  app.add_option("--width", s.wheel.width, "of the wheel [m], 0.02 to 2")->capture_default_str();
  app.add_option("--load", s.load, "on the wheel [N], 1 to 100000")->capture_default_str();
  app.add_option("--spin", spin, "[deg/s], 1 to 360")->capture_default_str();
  app.add_option("--slips", slips, "s = 1 - v/(omega r), from -5 to 0.95, with commas between them")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--bulldozing", s.bulldozing, "share of the soil pressed aside that is piled up there, 0 to 1")
      ->capture_default_str();
  app.add_option("--spacing", s.spacing,
                 "of the columns [m], 0.001 to 0.05, a quarter of the radius and half the width at most")
      ->capture_default_str();
  app.add_option("--travel", s.travel, "[m], 0.05 to 10; 0: 0.3, or one and a half radii, whichever is more");
  app.add_option("--output", output, "folder for the results")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!dem::rig::may_run("soil_columns", argv[0])) return 1;
  try {
    const auto require_kind = [&](const CLI::Option* option, const char* name, const char* of) {
      if (option->count() > 0 && kind != of)
        fail("{} is of --wheel {}, but the wheel is {}; leave it out", name, of, kind);
    };
    require_kind(grouser_option, "--grouser", "grousers");
    require_kind(friction_option, "--friction", "smooth");
    require_within(grouser, 1e-3, 0.1, "--grouser (m)");
    require_within(friction, 0.0, 2.0, "--friction");
    require_within(s.wheel.radius, 0.05, 2.0, "--radius (m)");
    require_within(s.wheel.width, 0.02, 2.0, "--width (m)");
    require_within(s.load, 1.0, 1e5, "--load (N)");
    require_within(spin, 1.0, 360.0, "--spin (deg/s)");
    require_within(s.bulldozing, 0.0, 1.0, "--bulldozing");
    std::sort(slips.begin(), slips.end());
    for (const double slip : slips) require_within(slip, -5.0, 0.95, "a slip of --slips, 1 - v/(omega r)");
    s.spin = radians(spin);
    require_within(s.spacing, 1e-3, std::min({0.05, 0.25 * s.wheel.radius, 0.5 * s.wheel.width}),
                   "--spacing (m; a quarter of the radius and half the width at most)");
    if (s.travel == 0.0) s.travel = std::max(0.3, 1.5 * s.wheel.radius);
    s.wheel_mass = std::min(std::max(1.5, 0.1 * s.load / 9.81), 0.5 * s.load / 9.81);  // kg; the rest is the hub's
    require_within(s.travel, 0.05, 10.0, "--travel (m)");
    if (!soil.empty()) named = find_soil(soil);
    s.soil = named.soil;
    if (kind == "grousers") s.wheel.grouser_height = grouser;
    if (kind == "smooth") s.friction = friction;
    // What columns assume: pressure largest at the lowest point, shear along the way that the rim slides.
    Soil plain = s.soil;
    plain.a0 = plain.a1 = 0.0;
    const WheelModel one_path = {.braked = BrakedShear::one_path};
    const char* quantities[3] = {"pull [N]", "torque [N m]", "sinkage [mm]"};
    const char* models[3] = {"columns", "thesis eqs. 1-11", "eqs. with a0 = a1 = 0, one path"};
    io::Table table{
        .caption = fmt::format("{}, {} N, {} wheel: columns / thesis eqs. 1-11 / the same with a0 = a1 = 0, "
                               "one path",
                               named.name, s.load, kind),
        .header = {"slip"},
        .digits = 4};
    io::Plot plots[3];
    for (int q = 0; q < 3; ++q) {
      plots[q] = {.title = fmt::format("Wheel on {}, {} N", named.name, s.load),
                  .x_label = "slip 1 - v/(ωr)",
                  .y_label = quantities[q]};
      for (const char* model : models) {
        plots[q].series.push_back({.name = model, .style = io::SeriesStyle::LinePoints});
        table.header.push_back(model == models[0] ? quantities[q] : model == models[1] ? "eqs." : "plain");
      }
    }
    const std::filesystem::path folder(output);
    io::AtomicFile{folder / "wheel.csv"};  // can be written; it is gone again, for it is not committed
    std::vector<std::vector<double>> rows;
    if (kind == "grousers") fmt::print("Sinkage on columns is that of the tips, by the equations that of the rim.\n");
    if (kind == "smooth") fmt::print("The equations know no smooth rim: theirs are of soil on soil.\n");
    const std::clock_t start = std::clock();
    double simulated = 0.0;
    ColumnField field;
    double field_slip = rig::not_known;
    std::string refused;  // why the newest gap is one
    const auto carried = [&](const auto& find) -> std::optional<decltype(find())> {
      try {
        return find();
      } catch (const Error& error) {
        refused = error.what();
        return {};
      }
    };
    double largest[3] = {}, changed[3] = {};  // of each quantity, and by how much columns half as wide change it
    for (const double slip : slips) {
      const auto roll = [&](const ColumnWheel& w) {
        const auto found = carried([&] { return roll_on_columns(w, slip); });
        if (found) simulated += w.travel / (w.spin * w.wheel.radius * (1.0 - slip));
        return found;
      };
      const std::optional<ColumnWheelRun> c = roll(s);
      if (c) field = c->field, field_slip = slip;
      if (c && halve) {
        ColumnWheel half = s;
        half.spacing *= 0.5;
        if (const std::optional<ColumnWheelRun> f = roll(half)) {
          field = f->field;
          const double pairs[3][2] = {{c->pull, f->pull}, {c->torque, f->torque}, {c->sinkage, f->sinkage}};
          for (int q = 0; q < 3; ++q) {
            largest[q] = std::max(largest[q], std::abs(pairs[q][0]));
            changed[q] = std::max(changed[q], std::abs(pairs[q][0] - pairs[q][1]));
          }
        }
      }
      std::vector<double> row(10, rig::not_known);
      row[0] = slip;
      const auto put = [&](std::size_t model, const auto& found) {
        if (found) row[model] = found->pull, row[model + 3] = found->torque, row[model + 6] = 1e3 * found->sinkage;
      };
      put(1, c);
      put(2, carried([&] { return wheel_under_load(s.wheel, s.soil, {slip}, s.load); }));
      put(3, carried([&] { return wheel_under_load(s.wheel, plain, {slip}, s.load, one_path); }));
      rows.push_back(row);
      std::vector<std::string> cells;
      for (const double x : row) cells.push_back(std::isfinite(x) ? io::format_number(x, table.digits) : "-");
      table.rows.push_back(cells);
      for (std::size_t k = 0; k < 9; ++k) {
        if (!std::isfinite(row[k + 1])) continue;
        plots[k / 3].series[k % 3].x.push_back(slip);
        plots[k / 3].series[k % 3].y.push_back(row[k + 1]);
      }
    }
    if (!std::isfinite(field_slip)) fail("the wheel rolls at no slip: {}", refused);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    fmt::print("{}{:.0f} s of rolling took {:.2f} s of one core: {:.1f} times real time; results in {}\n",
               io::to_text(table), simulated, seconds, simulated / seconds, output);
    if (!refused.empty()) fmt::print("Gaps are where there is no result: {}\n", refused);
    for (int q = 0; q < 3 && halve && largest[q] > 0.0; ++q) {
      fmt::print("columns half as wide change the {} by {:.2f} % of its largest at most\n", quantities[q],
                 100.0 * changed[q] / largest[q]);
    }
    // The last rut, across its middle.
    io::Plot across{.title = fmt::format("Rut behind the wheel at slip {:g}", field_slip),
                    .x_label = "across [mm]",
                    .y_label = "height [mm]"};
    across.series.push_back({.name = "surface"});
    const std::size_t middle = field.grid.nx / 2;
    for (std::size_t iy = 0; iy < field.grid.ny; ++iy) {
      across.series[0].x.push_back(1e3 * field.grid.y(iy));
      across.series[0].y.push_back(1e3 * field.surface(field.grid.row(middle, iy)));
    }
    // Results of an earlier run in the folder are replaced only now, all together.
    io::CsvWriter csv(folder / "wheel.csv",
                      {"slip_1-v/(omega*r)", "pull_N", "eqs_pull_N", "plain_pull_N", "torque_Nm", "eqs_torque_Nm",
                       "plain_torque_Nm", "sinkage_mm", "eqs_sinkage_mm", "plain_sinkage_mm"});
    for (const auto& r : rows) {
      using rig::cell;
      csv.row(cell(r[0]), cell(r[1]), cell(r[2]), cell(r[3]), cell(r[4]), cell(r[5]), cell(r[6]), cell(r[7]),
              cell(r[8]), cell(r[9]));
    }
    csv.flush();
    for (int q = 0; q < 3; ++q) io::render_plot(plots[q], folder / std::array{"pull", "torque", "sinkage"}[q]);
    io::render_plot(across, folder / "rut_across");
    write_rut_csv((folder / "rut.csv").string(), field);
    write_rut_pgm((folder / "rut.pgm").string(), field);
    write_rut_vtk((folder / "rut.vtp").string(), field);
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
