// expect: Shape: needs .static constexpr int pose_size., doubles cached per grain
#include <dem/geometry/sphere/sphere.hpp>

struct Blob {};

int main() { dem::shape::check_shape<Blob>(); }
