#include "world/scenes.hpp"

#include <dem/soil/ground_surface.hpp>

#include "core/error_of.hpp"

#include <cmath>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("the cross-section of a furrow and its ridge has the areas that grains stand below and above the level") {
  // 40 x 20 columns of balls of 1 mm radius, one beside the other; at y of 8 to 12 mm two layers are missing, at 14 to
  // 16 mm there is one more.
  constexpr double r = 1e-3;
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  const auto kind = w.add_species(Sphere(r));
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 20; ++j) {
      const int layers = j == 4 || j == 5 ? 2 : j == 7 ? 5 : 4;
      for (int k = 0; k < layers; ++k) w.add_grain({kind, Vec3(r + 2 * r * i, r + 2 * r * j, r + 2 * r * k)});
    }
  }
  // Cells of a ball's edge see its top.
  const auto field = dem::soil::height_field(w, {.x0 = 0, .y0 = 0, .length = 0.08, .width = 0.04, .cell = 2 * r});
  CHECK(field.along() == 40);
  CHECK(field.across == 20);
  const auto section = dem::soil::cross_section(field, 0.02, 0.06);
  CHECK(section.y[4] == Approx(9e-3));
  CHECK(section.z[4] == Approx(4e-3));
  CHECK(section.z[7] == Approx(10e-3));
  CHECK(section.z[0] == Approx(8e-3));
  CHECK(section.area_below(8e-3) == Approx(4e-3 * 4e-3));
  CHECK(section.area_above(8e-3) == Approx(2e-3 * 2e-3));
  CHECK(section.mean() == Approx((17 * 8e-3 + 2 * 4e-3 + 10e-3) / 20));
  // Beyond the grains there is nothing, and what lies beyond the plan does not enlarge it.
  const auto beside =
      dem::soil::height_field(w, {.x0 = 0.07, .y0 = 0.03, .length = 0.02, .width = 0.02, .cell = 2 * r});
  CHECK(beside.along() == 10);
  CHECK(std::isnan(beside.z.back()));
  CHECK(dem::soil::cross_section(beside, 0.07, 0.08).z[0] == Approx(8e-3));
  CHECK(std::isnan(dem::soil::cross_section(beside, 0.081, 0.09).mean()));
  // A tool's own grains above the furrow are no ground.
  w.add_grain({w.add_species(Sphere(r), {.held = true}), Vec3(r, 9 * r, 0.05)});
  CHECK(dem::soil::height_field(w, {.x0 = 0, .y0 = 0, .length = 0.08, .width = 0.04, .cell = 2 * r}).z == field.z);
  CHECK_THAT(message_of([&] { dem::soil::height_field(w, {.length = 1, .width = 1, .cell = 1e-5}); }),
             ContainsSubstring("width of a height field in cells"));
  CHECK_THAT(message_of([&] { dem::soil::height_field(w, {.length = 1, .width = 1}); }),
             ContainsSubstring("cell of a height field"));
}
