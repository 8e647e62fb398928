// The law of rims on meshes (own; doc/contact.md, "The rim"): there nodes are not on the surface,
// so columns of them, one behind the other, stand at a flat face's edges as vertices of a block do.
//
// A column runs along the lattice's axis that is nearest to the face's normal at rest. Where it is
// on the face is told by the touches around it: the mean of where each would have it, did the
// surface between them stick to the face.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "rim_link.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/loading_patch.h"
#include "world.h"

namespace robot_tissue {

// What a look at the columns leaves to the next; of links and columns.
struct RimColumnState {
  struct Column {
    Vec3 place = Vec3::Zero(), rest = Vec3::Zero();  // m; sums of touches', then their means
    double weight = 0.0;                             // of the touches
    RimModuli moduli;                                // likewise
    std::vector<FaceEdge> edges;
    double share = 0.0;                                  // Rim::share
    double normal = 0.0;                                 // m/N
    Eigen::Matrix3d friction = Eigen::Matrix3d::Zero();  // m/N
  };
  using Key = std::pair<int, NodeColumn>;
  std::map<int, int> axes;
  std::map<Key, Column> columns, last_columns;
  std::map<Key, double> shares;       // of the load step
  std::map<Key, double> last_shares;  // of the touches when it began
};

class RimColumns {
 public:
  // The state is kept by the caller.
  RimColumns(const World& world, RimColumnState& state) : world_(world), state_(state) {}

  void beginStep();
  // A look at all links begins.
  void begin();
  // At a link, with its contacts among these; places of the surface's vertices.
  void look(const RimLink& link, const std::vector<Vec3>& vertices, const ContactSet& contacts);
  // That a contact is between, as far as they give way.
  std::vector<RimColumn> around(const Contact& contact) const;

 private:
  using Column = RimColumnState::Column;
  using Key = RimColumnState::Key;

  bool isOnFace(const Contact& contact, const RimLink& link) const;
  void add(const Contact& contact, const RimLink& link);
  void findEdges(const Key& key, const RimLink& link, Column& column);
  void soften(const RimLink& link, const std::vector<int>& near, Column& column) const;
  std::vector<int> verticesNear(const RimLink& link, const std::vector<Vec3>& vertices) const;
  double tissueBeyond(const FaceEdge& edge, const RimLink& link, const std::vector<int>& near,
                      const Column& column) const;
  Vec3 restOf(const Contact& contact) const;
  std::vector<std::pair<NodeColumn, double>> weightsAt(const Vec3& rest, int axis) const;
  Vec3 placeOf(const NodeColumn& column, const Vec3& rest) const;

  const World& world_;
  RimColumnState& state_;
};

}  // namespace robot_tissue
