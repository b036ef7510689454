#pragma once

#include <dem/rig/bed/bed.hpp>
#include <dem/rig/part_of.hpp>
#include <dem/rig/session.hpp>

namespace dem::rig {

/// The bed of a test, as a part of the run that is kept by itself: a run that goes on takes it from its file.
template <class Test>
Bed<typename Test::Model> make_kept_bed(const Test& test, const soil::Packing& start, Session& session) {
  PartOf<typename Test::Model> part(session, session, "bed");
  Bed<typename Test::Model> bed = test.make_bed(start, session);
  const auto kept = session.keep("bed", bed);
  session.complete(bed.world);
  return bed;
}

}  // namespace dem::rig
