#pragma once

// All kinds of joint of the library.

#include <dem/mbd/joint/bushing.hpp>
#include <dem/mbd/joint/bushing_tables.hpp>
#include <dem/mbd/joint/constant_velocity.hpp>
#include <dem/mbd/joint/cylindrical.hpp>
#include <dem/mbd/joint/distance.hpp>
#include <dem/mbd/joint/fixed.hpp>
#include <dem/mbd/joint/free.hpp>
#include <dem/mbd/joint/planar.hpp>
#include <dem/mbd/joint/plunging_constant_velocity.hpp>
#include <dem/mbd/joint/point_on_line.hpp>
#include <dem/mbd/joint/point_on_plane.hpp>
#include <dem/mbd/joint/prismatic.hpp>
#include <dem/mbd/joint/revolute.hpp>
#include <dem/mbd/joint/spherical.hpp>
#include <dem/mbd/joint/universal.hpp>
