#pragma once

namespace scenes {

bool spheres();   ///< fall into a box, are put in, taken out, added and removed by hand
bool cubes();     ///< of eight spheres, with a machine, a mesh, grains that are held, and sleep
bool periodic();  ///< cubes in a cell that repeats itself: they flow over its borders, sleep, and a paddle goes across
bool checkpoint();  ///< a state goes on from ranks to one process and back
void mistake();     ///< an exception on one rank
void disagree();    ///< ranks that set up different worlds

}  // namespace scenes
