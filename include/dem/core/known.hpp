#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>

namespace dem {

/// Throws Error for an id that was never given; `what` is the kind of item that it should name, `count` how many there
/// are.
template <class Id>
[[noreturn]] void fail_unknown(Id id, std::size_t count, const char* what) {
  if (!id.valid()) fail("the {} that is asked for has an id that was never set; use the one that was returned", what);
  fail("{} {} is asked for, but is not known (added so far: {}); use the id that was returned", what, id.value, count);
}

/// What an id names. Throws Error for an id that was never given.
template <class Items, class Id>
auto& known(Items& items, Id id, const char* what) {
  if (id.index() >= items.size()) fail_unknown(id, items.size(), what);
  return items[id.index()];
}

}  // namespace dem
