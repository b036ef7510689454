#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

namespace dem::mbd::detail {

BodyId add_body(Parts& parts, BuiltBody built, bool is_ground = false);

ConnectionId add_connection(Parts& parts, std::string name, BodyId body, const Vec3& at);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE BodyId add_body(Parts& parts, BuiltBody built, bool is_ground) {
  settle_name(built.body.name, parts.bodies, "body", "bodies", [](const Body& b) { return b.name; });
  require_no_step(parts);
  is_ground ? parts.bodies.add_ground(built.body) : parts.bodies.add(built.body);
  return keep<BodyId>(parts, parts.built, std::move(built));
}

DEM_INLINE ConnectionId add_connection(Parts& parts, std::string name, BodyId body, const Vec3& at) {
  const std::string who = dem::text("connection point '{}'", name);
  const Body& b = known_body(parts, body, who);
  settle_name(name, parts.connections, "connection point", "connection points",
              [](const Connection& c) { return c.name; });
  Connection c{std::move(name), body, to_eigen(to_body(b, finite_point(at, who))), at};
  return keep<ConnectionId>(parts, parts.connections, std::move(c), false);
}

}  // namespace dem::mbd::detail

#endif
