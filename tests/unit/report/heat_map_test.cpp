#include <dem/report/heat_map.hpp>

#include <limits>

#include "catch.hpp"

using Catch::Matchers::ContainsSubstring;

TEST_CASE("the script of a heat map has each cell with its edges, grey ones apart, and words where they are asked") {
  dem::io::HeatMap map{.title = "Where it's good",
                       .c_label = "speed",
                       .x = {0, 1, 3},
                       .y = {10, 20},
                       .value = {1, 2, 3, 4, 5, std::numeric_limits<double>::quiet_NaN()},
                       .texts = {"a", "b", "c", "d", "e", "no"},
                       .y_ticks = {"sand", "10 % clay"}};
  const std::string script = gnuplot_script(map, "map");
  CHECK_THAT(script, ContainsSubstring("\n1 10 0.5 2 5 15 2\n"));
  CHECK_THAT(script, ContainsSubstring("$empty << END\n3 20 2 4 15 25 0\nEND"));
  CHECK_THAT(script, ContainsSubstring("set ytics ('sand' 10, '10 %% clay' 20)"));  // gnuplot reads formats
  CHECK_THAT(script, ContainsSubstring("set label 'no' at 3,20"));
  CHECK_THAT(script, ContainsSubstring("set output './map.png'"));
  map.value.pop_back();
  CHECK_THROWS_WITH(gnuplot_script(map, "map"), ContainsSubstring("3 x 2 cells have 5 values and 6 texts"));
  map = {.x = {1, 0}, .y = {0}, .value = {1, 2}};
  CHECK_THROWS_WITH(gnuplot_script(map, "map"), ContainsSubstring("do not ascend"));
}
