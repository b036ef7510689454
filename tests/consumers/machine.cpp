// A second source that uses dem: an arm that falls about its hinge.
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/mbd/mbd.hpp>

double falls() {
  using namespace dem::mbd;
  Machine<dem::integrator::PredictorCorrector> m;
  const dem::BodyId arm = m.add_body(box_body("arm", {1, 0.1, 0.1}, 2700).at({0.5, 0, 0}));
  const dem::JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 0, 0}, {0, 1, 0}));
  return m.run(0.1, 1e-4) ? m.coordinate(hinge) : 0.0;
}
