#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "loads/dof_constraints.h"
#include "material/elastic_model.h"
#include "mesh_fixtures.h"
#include "solvers/multigrid/hierarchy/coarse_correction.h"
#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

namespace robot_tissue::test_coarse_correction {
namespace {

// The grid around a ball has corners that are no nodes. What coarse levels say there moves nothing,
// and is no motion that is left.
TEST(CoarseCorrection, MovesWhatIsThereAlone) {
  TissueConfig config;
  config.model = "elastic";
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(0.03, 3));
  config.fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, -0.02)}};
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  ConstrainedState shape{lattice.restState(), {}};
  DofConstraints hold(lattice, model);
  hold.bind(shape);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (lattice.isFixed(node)) continue;
    shape.state.displacement[at(node)] =
        Vec3(0, 0, -0.05 * (lattice.restPosition(node).z() + 0.02));
  }
  GridHierarchy<double> levels(lattice, model, *shape.state.cells, nullptr);
  levels.constraints().bind(shape, hold);
  levels.displacements().take(shape.state.displacement, hold.dirichletMask());
  levels.finest().findForces();
  levels.correction().find();
  double of_nodes = 0.0, elsewhere = 0.0;
  int missing = 0;
  for (int entry = 0; entry < levels.finest().count(); ++entry) {
    const double way = vectorAt(levels.correction().motion(), entry).norm();
    const bool exists = levels.finest().exists(entry);
    double& longest = exists ? of_nodes : elsewhere;
    longest = std::max(longest, way);
    if (!exists) ++missing;
  }
  EXPECT_GT(missing, 0);
  EXPECT_GT(of_nodes, 0.0);
  EXPECT_EQ(elsewhere, 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_coarse_correction
