// expect: SphereCluster<N>: N must lie between 1 and 256
#include <dem/shape/sphere_cluster.hpp>

int main() { static_cast<void>(sizeof(dem::shape::SphereCluster<0>)); }
