// expect: SphereCluster<N>: N must lie between 1 and 256
#include <dem/geometry/cluster/sphere_cluster.hpp>

int main() { static_cast<void>(sizeof(dem::shape::SphereCluster<0>)); }
