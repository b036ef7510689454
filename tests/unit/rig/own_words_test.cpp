#include "catch.hpp"

#include <dem/rig/own_words.hpp>

namespace own_words_test {

using dem::rig::in_own_words;
using dem::rig::OwnWord;

TEST_CASE("what the library calls otherwise is said in the program's words, and nothing else changes") {
  const OwnWord words[] = {{"time_step", "--time-step"},
                           {"skin", "--reach"},
                           {"raise the skin", "raise --reach"},
                           {", or enlarge domain", ""}};
  const auto said = [&](const char* text) { return in_own_words(text, words); };
  CHECK(said("") == "");
  CHECK(said("time_step") == "--time-step");
  CHECK(said("lower time_step, or enlarge domain") == "lower --time-step");
  CHECK(said("raise the skin") == "raise --reach");
  CHECK(said("time_step_safety, my_time_step, --skin, skins") == "time_step_safety, my_time_step, --skin, skins");
  CHECK(said("'skin/time_step' and skin") == "'skin/time_step' and --reach");
  CHECK(said("out/skin/time_step.csv") == "out/skin/time_step.csv");
  CHECK(said("a grain's skin") == "a grain's --reach");
  CHECK(said("'it's skin', skin") == "'it's skin', --reach");
  CHECK(said("'no end of skin") == "'no end of --reach");
}

}  // namespace own_words_test
