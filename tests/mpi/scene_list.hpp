#pragma once

namespace scenes {

// Some scenes of these count energy too.
bool spheres();   ///< fall into a box, are put in, taken out, added and removed by hand, also beside sleepers
bool cubes();     ///< of eight spheres, with a machine, a mesh, grains that are held, and sleep
bool periodic();  ///< cubes in a cell that repeats itself: they flow over its borders, sleep, and a paddle goes across
bool tiles();     ///< beds of tiles, and a patch that goes along with a plough, asleep and awake
bool checkpoint();    ///< a state goes on from ranks to one process and back
bool reports();       ///< what is reported of lost grains
bool differ();        ///< ranks with different set-ups are told in what
bool differ_later();  ///< ranks that steer the machine differently between runs, or add other inlets, are told so
void mistake();       ///< an exception on one rank
void disagree();      ///< ranks that change different things
void steered();       ///< ranks that give a motor different speeds between runs
void other_shear();   ///< ranks that shear a cell at different rates

// Two ranks in different calls.
bool caught();              ///< an exception on one rank, between steps, which is caught
void contacts_on_one();     ///< one rank looks at contacts
void columns_on_one();      ///< one rank takes the state
void run_on_one();          ///< one rank runs
void tiles_on_one();        ///< one rank lays tiles
void other_tiles();         ///< ranks lay different beds of tiles
void added_before_tiles();  ///< ranks have added grains at different places before

}  // namespace scenes
