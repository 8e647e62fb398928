// Touches at the rim of a flat face on a mesh, whose nodes are not on the surface: columns of nodes
// give way at the face's edges, each by what all its touches press it with (doc/contact.md, "The
// rim").
//
//   force of a column C        F_C = sum over its touches of w_iC multiplier_i
//   plane of a touch i         inside the tool by  sum over its columns of w_iC c_C F_C
//   its spring                 in series with      sum over its columns of w_iC c_C S_C,
//                              S_C = sum over C's touches of w_iC: as if they pressed alike
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {
namespace {

bool isIn(const NodeColumn& column, const std::array<int, 3>& index) {
  const std::size_t axis = at(column[0]);
  return index[(axis + 1) % 3] == column[1] && index[(axis + 2) % 3] == column[2];
}

// Along the friction: the mean of all ways along the face where there is none.
double frictionCompliance(const RimColumn& column, const Vec3& friction) {
  const double squared = friction.squaredNorm();
  return squared > 0.0 ? friction.dot(column.friction * friction) / squared
                       : 0.5 * column.friction.trace();
}

}  // namespace

double SlidingContacts::columnRecess(int link, const std::vector<RimColumn>& columns) const {
  double recess = 0.0;
  for (const RimColumn& column : columns) {
    const auto way = column_ways_.find({link, column.line});
    if (way != column_ways_.end()) recess += column.weight * way->second;
  }
  return recess;
}

// After multipliers or touches changed.
void SlidingContacts::softenColumns(const Tissue& tissue) {
  struct Press {
    double force = 0.0, touches = 0.0;
  };
  std::map<std::pair<int, NodeColumn>, Press> presses;
  for (const ContactConstraint& touch : touches_) {
    for (const RimColumn& column : touch.contact.columns) {
      Press& press = presses[{touch.contact.link, column.line}];
      press.force += column.weight * touch.spring.multiplier;
      press.touches += column.weight;
    }
  }
  column_ways_.clear();
  for (ContactConstraint& touch : touches_) {
    touch.of_columns = {};
    for (const RimColumn& column : touch.contact.columns) {
      const Press& press = presses.at({touch.contact.link, column.line});
      const double part = column.weight * press.touches;
      touch.of_columns.normal += part * column.normal;
      touch.of_columns.friction += part * frictionCompliance(column, touch.spring.friction_force);
      column_ways_[{touch.contact.link, column.line}] = column.normal * press.force;
    }
  }
  for (ContactConstraint& touch : touches_) {
    showColumns(tissue, touch);
    if (touch.contact.columns.empty()) continue;  // softened by itself, where it was put
    touch.column_recess = columnRecess(touch.contact.link, touch.contact.columns);
    soften(tissue, touch);
  }
}

// Nodes of a column are shown where they would be, did it not give way.
void SlidingContacts::showColumns(const Tissue& tissue, ContactConstraint& touch) const {
  ContactSpring& spring = touch.spring;
  spring.carrier_ways.clear();
  if (touch.contact.columns.empty()) return;
  for (const NodeWeight& carrier : spring.carriers) {
    const std::array<int, 3> index = tissue.lattice().gridIndex(carrier.node);
    double& way = spring.carrier_ways.emplace_back(0.0);
    for (const RimColumn& column : touch.contact.columns) {
      const auto found = column_ways_.find({touch.contact.link, column.line});
      if (found != column_ways_.end() && isIn(column.line, index)) way = found->second;
    }
  }
}

}  // namespace robot_tissue
