#include "catch.hpp"

#include <dem/rig/config_text.hpp>

#include <string>
#include <vector>

namespace config_text_test {

using Catch::Matchers::ContainsSubstring;
using dem::rig::read_config;
using Values = std::vector<std::string>;

namespace {

Values values_of(const std::string& text) {
  const auto lines = read_config(text);
  REQUIRE(lines.size() == 1);
  return lines[0].values;
}

}  // namespace

TEST_CASE("lines of a settings file") {
  const auto lines = read_config("# a comment\n; another\n\n  travel = 0.006  # m\r\n\"size\"='smoke'\nvtk\n");
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].key == "travel");
  CHECK(lines[0].values == Values{"0.006"});
  CHECK(lines[0].line == 4);
  CHECK(lines[1].key == "size");
  CHECK(lines[1].values == Values{"smoke"});
  CHECK(lines[2].key == "vtk");
  CHECK(lines[2].values == Values{"true"});
  CHECK(read_config("").empty());
  CHECK(read_config("# only a comment").empty());
}

TEST_CASE("values of a settings file") {
  CHECK(values_of("a = euler") == Values{"euler"});
  CHECK(values_of("a = -1e-3") == Values{"-1e-3"});
  CHECK(values_of("a = [6.2, 16.2]") == Values{"6.2", "16.2"});
  CHECK(values_of("a = [ 6.2, # kg\n  16.2,\n]") == Values{"6.2", "16.2"});
  CHECK(values_of("a = [\"x, y\", 'z']") == Values{"x, y", "z"});
  CHECK(values_of("a = 6.2, 16.2 26.2") == Values{"6.2", "16.2", "26.2"});
  CHECK(values_of("a = []").empty());
  CHECK(values_of(R"(a = "\"\\\t\n\u0041#")") == Values{"\"\\\t\nA#"});
  CHECK(values_of(R"(a = 'c:\new "x"')") == Values{R"(c:\new "x")"});
}

TEST_CASE("any text is read back as it was written") {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  for (const std::string& text : {all, std::string("\"a"), std::string("#"), std::string(" "), std::string()}) {
    CHECK(values_of("a = " + dem::rig::toml_text(text)) == Values{text});
  }
}

TEST_CASE("what is no settings file is refused with its line") {
  const auto refused = [](const std::string& text, const char* words) {
    INFO(text);
    CHECK_THROWS_WITH(read_config(text), ContainsSubstring(words));
  };
  refused("[contacts]\nfriction = 0.3", "a table [contacts]");
  refused("contacts.friction = 0.3", "a table [contacts]");
  refused("a = 1\n\nb =", "line 3");
  refused("= 1", "stands where a name or a value should");
  refused("a = \"x", "no quote at its end");
  refused("a = \"x\ny\"", "no quote at its end");
  refused("a = [1, 2", "line 1");
  refused("a = [1 2]", "a comma or ']'");
  refused("a = \"\\q\"", "'\\q' is no character");
  refused("a = \"\\u00e4\"", "above 007F");
  refused("a = \"\\u12\"", "four hexadecimal digits");
  refused("a = \"\\u1", "the file ends");
}

}  // namespace config_text_test
