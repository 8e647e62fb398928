#include "membrane/sheet_kernel.h"

#include <algorithm>

#include "simd/vectors.h"

namespace robot_tissue {
namespace {

using vectors::Vector;

// Of a vector in space, in lanes.
template <typename L>
struct Space {
  L x, y, z;

  ROBOT_TISSUE_INLINE Space operator-(const Space& b) const { return {x - b.x, y - b.y, z - b.z}; }
  ROBOT_TISSUE_INLINE Space operator+(const Space& b) const { return {x + b.x, y + b.y, z + b.z}; }
  ROBOT_TISSUE_INLINE Space operator*(const L& by) const { return {x * by, y * by, z * by}; }
  ROBOT_TISSUE_INLINE L dot(const Space& b) const { return x * b.x + y * b.y + z * b.z; }
  ROBOT_TISSUE_INLINE Space cross(const Space& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
};

// The square roots: of lanes, one by one, which compilers turn into one instruction.
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes rootOf(const typename V::Lanes& x) {
  typename V::Lanes root;
  for (int lane = 0; lane < V::kSize; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}

// StretchedTriangle::gradient.
template <typename V>
struct TriangleLanes {
  using L = typename V::Lanes;
  using Elements = SheetKernel::Triangles;

  ROBOT_TISSUE_INLINE static void find(const L (&number)[6], const Space<L> (&place)[3],
                                       Space<L> (&gradient)[3]) {
    const Space<L> along = place[1] - place[0], other = place[2] - place[0];
    const Space<L> one = along * number[2] + other * number[4];  // columns of F
    const Space<L> two = along * number[3] + other * number[5];
    const L c11 = one.dot(one), c12 = one.dot(two), c22 = two.dot(two);
    const L determinant = c11 * c22 - c12 * c12;
    const L power = vectors::exponential<V>(-number[1] * vectors::logarithm<V>(determinant));
    const L share = power / determinant;
    const L s11 = number[0] * (1.0 - share * c22), s22 = number[0] * (1.0 - share * c11);
    const L s12 = number[0] * share * c12;
    const Space<L> on_one = one * s11 + two * s12, on_two = one * s12 + two * s22;
    gradient[1] = on_one * number[2] + on_two * number[3];
    gradient[2] = on_one * number[4] + on_two * number[5];
    gradient[0] = Space<L>{} - gradient[1] - gradient[2];
  }
};

// Hinge::gradient.
template <typename V>
struct HingeLanes {
  using L = typename V::Lanes;
  using Elements = SheetKernel::Hinges;

  ROBOT_TISSUE_INLINE static void find(const L (&number)[2], const Space<L> (&place)[4],
                                       Space<L> (&gradient)[4]) {
    constexpr double kHalfTurn = 3.14159265358979323846;
    const Space<L> edge = place[1] - place[0];
    const Space<L> one = place[2] - place[0], other = place[3] - place[0];
    const Space<L> normal = edge.cross(one), other_normal = other.cross(edge);
    const L length = rootOf<V>(edge.dot(edge));
    const Space<L> direction = edge * (1.0 / length);
    const L angle =
        vectors::angleOf<V>(normal.cross(other_normal).dot(direction), normal.dot(other_normal));
    L bent = angle - number[1];
    bent = bent > kHalfTurn ? bent - 2.0 * kHalfTurn : bent;
    bent = bent < -kHalfTurn ? bent + 2.0 * kHalfTurn : bent;
    const L moment = number[0] * bent;
    const Space<L> scaled = normal * (moment / normal.dot(normal));
    const Space<L> other_scaled = other_normal * (moment / other_normal.dot(other_normal));
    const L along = one.dot(direction), other_along = other.dot(direction);
    gradient[0] = scaled * (length - along) + other_scaled * (length - other_along);
    gradient[1] = scaled * along + other_scaled * other_along;
    gradient[2] = scaled * -length;
    gradient[3] = other_scaled * -length;
  }
};

// Lanes beyond the last element take it again, and leave nothing.
template <typename V, template <typename> class Law>
ROBOT_TISSUE_INLINE void addAllOf(const typename Law<V>::Elements& elements, const Vec3* places,
                                  Vec3* forces) {
  using L = typename V::Lanes;
  constexpr std::size_t kAll = Law<V>::Elements::kElementCorners;
  const int count = static_cast<int>(elements.vertices.size());
  for (int first = 0; first < count; first += V::kSize) {
    constexpr std::size_t kNumberCount =
        std::tuple_size<typename decltype(elements.numbers)::value_type>::value;
    double numbers[kNumberCount][V::kSize], places_of[kAll][3][V::kSize];
    for (int lane = 0; lane < V::kSize; ++lane) {
      const std::size_t element = at(std::min(first + lane, count - 1));
      for (std::size_t i = 0; i < kNumberCount; ++i) {
        numbers[i][lane] = elements.numbers[element][i];
      }
      for (std::size_t corner = 0; corner < kAll; ++corner) {
        const double* from = places[elements.vertices[element][corner]].data();
        for (int axis = 0; axis < 3; ++axis) places_of[corner][axis][lane] = from[axis];
      }
    }
    L number[kNumberCount];
    for (std::size_t i = 0; i < kNumberCount; ++i) number[i] = vectors::load<V>(numbers[i]);
    Space<L> place[kAll], gradient[kAll];
    for (std::size_t i = 0; i < kAll; ++i) {
      const auto& of = places_of[i];
      place[i] = {vectors::load<V>(of[0]), vectors::load<V>(of[1]), vectors::load<V>(of[2])};
    }
    Law<V>::find(number, place, gradient);
    for (int lane = 0; lane < std::min(V::kSize, count - first); ++lane) {
      for (std::size_t corner = 0; corner < kAll; ++corner) {
        double* to = forces[elements.vertices[at(first + lane)][corner]].data();
        to[0] -= gradient[corner].x[lane];
        to[1] -= gradient[corner].y[lane];
        to[2] -= gradient[corner].z[lane];
      }
    }
  }
}

// For one kind of processor.
#define ROBOT_TISSUE_SHEET_KERNELS(kind, bytes)                                                  \
  kind void addTrianglesHere(const SheetKernel::Triangles& triangles, const Vec3* places,        \
                             Vec3* forces) {                                                     \
    addAllOf<Vector<double, bytes>, TriangleLanes>(triangles, places, forces);                   \
  }                                                                                              \
  kind void addHingesHere(const SheetKernel::Hinges& hinges, const Vec3* places, Vec3* forces) { \
    addAllOf<Vector<double, bytes>, HingeLanes>(hinges, places, forces);                         \
  }

}  // namespace

ROBOT_TISSUE_FOR_EACH_PROCESSOR(ROBOT_TISSUE_SHEET_KERNELS)

void SheetKernel::add(const StretchedTriangle& law, const std::array<int, 3>& vertices) {
  const auto& slopes = law.slopes();
  triangles_.vertices.push_back(vertices);
  triangles_.numbers.push_back({law.shear() * law.area(), law.exponent(), slopes(0, 1),
                                slopes(1, 1), slopes(0, 2), slopes(1, 2)});
}

void SheetKernel::add(const Hinge& law, const std::array<int, 4>& vertices) {
  hinges_.vertices.push_back(vertices);
  hinges_.numbers.push_back({law.stiffness(), law.restAngle()});
}

void SheetKernel::addForces(const std::vector<Vec3>& places, std::vector<Vec3>& forces) const {
  addTrianglesHere(triangles_, places.data(), forces.data());
  addHingesHere(hinges_, places.data(), forces.data());
}

}  // namespace robot_tissue
