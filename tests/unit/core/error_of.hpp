#pragma once

#include "catch.hpp"

#include <dem/core/error.hpp>

#include <string>

/// The text of the dem::Error that `call` throws; a note when it throws none.
template <class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const dem::Error& error) {
    return error.what();
  }
  return "(no dem::Error was thrown)";
}

/// Every word must be in the message of the dem::Error that `call` throws.
template <class Call, class... Words>
void check_refused(Call&& call, Words... words) {
  const std::string text = message_of(call);
  for (const std::string word : {words...}) CHECK_THAT(text, Catch::Matchers::ContainsSubstring(word));
}
