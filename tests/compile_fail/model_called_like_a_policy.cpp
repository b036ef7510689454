// expect: Model: your model is called like one of its policies
#include <dem/world/model.hpp>

struct Rolling : dem::Model {};

int main() { dem::check_model<Rolling>(); }
