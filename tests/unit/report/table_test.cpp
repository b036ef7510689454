#include "catch.hpp"
#include "io/files.hpp"

#include <dem/report/ascii_table.hpp>

#include <cmath>
#include <string>

using dem::io::Align;
using dem::io::format_number;
using dem::io::looks_numeric;
using dem::io::Table;
using dem::io::to_text;

TEST_CASE("numbers are rounded for reading") {
  CHECK(format_number(0) == "0");
  CHECK(format_number(0.25) == "0.25");
  CHECK(format_number(25.118) == "25.12");
  CHECK(format_number(9999.6) == "10000");
  CHECK(format_number(12345.6) == "12346");
  CHECK(format_number(-1234567.8) == "-1234568");
  CHECK(format_number(2.5e9) == "2.5e+09");
  CHECK(format_number(1.23456e-5) == "1.235e-05");
  CHECK(format_number(1.0 / 3, 2) == "0.33");
  CHECK(format_number(std::copysign(std::nan(""), -1.0)) == "nan");
}

TEST_CASE("numbers are told from texts") {
  for (const auto* text : {"1", "-1.2e+05", "43 %", "31 ± 2", "nan", "-inf", ".5"}) CHECK(looks_numeric(text));
  for (const auto* text : {"", "-", "e", "loose", "25 deg", "1e5x", "±"}) CHECK(!looks_numeric(text));
}

TEST_CASE("a table is aligned") {
  Table table{.caption = "Friction", .header = {"angle [deg]", "τ [kPa]", "packing", "ok"}};
  table.row(25.123, 101, "loose", true).row(7.5, "-", "dense, µ = 0.4", false);
  CHECK(to_text(table) ==
        "Friction\n"
        "angle [deg]  τ [kPa]  packing         ok\n"
        "-----------  -------  --------------  ---\n"
        "      25.12      101  loose           yes\n"
        "        7.5        -  dense, µ = 0.4  no\n");
}

TEST_CASE("a column's alignment can be chosen") {
  Table table{.header = {"a", "b", "c"}, .align = {Align::Left, Align::Center, Align::Right}};
  table.row(1, 2, "x").row(100, "long", "yyy");
  CHECK(to_text(table) ==
        "a     b      c\n"
        "---  ----  ---\n"
        "1     2      x\n"
        "100  long  yyy\n");
}

TEST_CASE("a table prints, also without rows") {
  Captured out;
  dem::io::print(Table{.header = {"a", "bb"}}, out.file());
  CHECK(out.take() == "a  bb\n-  --\n");
}

TEST_CASE("a row of wrong length is refused") {
  Table table{.caption = "T", .header = {"a", "b"}};
  CHECK(error_of([&] { table.row(1); }) ==
        "table 'T': a row has 1 cells, but the header has 2; give one cell a column");
  table.rows = {{"1", "2"}, {"3"}};
  CHECK(error_of([&] { (void)to_text(table); }) ==
        "table 'T': row 1 has 1 cells, but the header has 2; give one cell a column");
}

TEST_CASE("text is measured and cut by code points") {
  CHECK(dem::io::display_width("σ = 1 m²") == 8);
  CHECK(dem::io::clip("σµ²", 2) == "σµ");
  CHECK(dem::io::clip("ab", 5) == "ab");
  CHECK(dem::io::clip("ab", 0).empty());
  CHECK(dem::io::one_line("a\n\tb\x1b[0m") == "a  b [0m");
}
