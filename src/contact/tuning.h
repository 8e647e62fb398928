// The numbers of contact geometry in one place: unit, where each comes from, and what turning it
// does. "edge" is the longest edge of a triangle of the tissue's surface, "thickness" that of a
// shape. Chosen: by judgment, and kept as the tests of geometry passed; no other value was measured
// against it. Rounding: above what double precision leaves, far below what a contact feels.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Where on a triangle the distance to a shape is least.
// Of the edge and of the thickness (1), whichever is less: how exact. Less: more distances asked
// for. Chosen.
constexpr double kAccuracyOfEdge = 0.005;
constexpr double kAccuracyOfThickness = 0.02;
// Of the edge (1): it is never finer. More: contacts of thin tools are coarse; less: more
// distances. Chosen.
constexpr double kFinestOfEdge = 0.001;
// Of the accuracy (1): where nothing less than the limit was found, a bound so near to the best
// ends the search. Less: more distances asked for in vain; more: contacts at the limit are missed.
// Chosen.
constexpr double kAccuracyAtLimit = 1e-3;
// Planes over one triangle, and so distances, at most. More: searches that end here would come
// nearer to their accuracy, the last planes being the dearest. Chosen.
constexpr std::size_t kMostPlanes = 32;

// The same of a mesh, which is convex in parts only: a search from each seed.
// Steps of one search at most. More: exact in more cases, slower where a shape is rough. Chosen.
constexpr std::size_t kMostLocalSteps = 24;
// Projections to and fro before a search beside a part that folds outwards only, at most. More:
// more exact beside what is not met. Chosen.
constexpr int kApproaches = 3;
// Of the edge (1): how far the planes are believed at first. More: fewer steps on smooth shapes,
// but a search may leave its own hollow; less: more steps. Chosen.
constexpr double kFirstPart = 0.125;
// Of the gain that the planes foretold (1): with a larger one, they are believed twice as far.
// More: shorter steps. Chosen.
constexpr double kGoodShare = 0.25;
// Of the edge (1): two least points that are nearer are one contact. More: fewer contacts of a
// rough mesh; less: several where it touches once. Chosen.
constexpr double kSamePlace = 0.05;
// Of the edge of two triangles (1): contacts on it that are nearer along it are one. More: fewer;
// less: each triangle adds its own. Chosen.
constexpr double kSameAlong = 0.02;
// Of the mesh's diagonal (1): with less height of the one triangle over the other, an edge does not
// fold inwards. Rounding of meshes in single precision.
constexpr double kFlatEdge = 1e-6;
// Of the edge (1): a segment of a mesh in the triangle that is shorter is a point. Rounding.
constexpr double kAtOnePoint = 1e-9;
// Cosine, and its square's shortage from 1: two directions are square, or not parallel. Rounding.
constexpr double kSquare = 1e-9;
// Of an edge (1): a point that is farther before or after it along it has its foot on none of it.
// Far above rounding where segments are nearly parallel (kSquare); more: more of them are compared.
constexpr double kSurelyOffEdge = 1e-3;

// Of the edge (1): triangles that went no farther since their deepest places were looked for are
// followed from these. More: fewer are looked for, but a place that only now comes near is met
// later. Chosen: a fifth of how far off a tool places are kept.
constexpr double kFollowed = 0.05;

// Equal or not.
// m, and of a distance (1): what a bound of a distance is widened by. Less: the nearest face may be
// missed; more: more faces are asked. Rounding.
constexpr double kRounding = 1e-12;
constexpr double kBeyondRounding = 1e-9;
// m: another shape of the link is deeper, and speaks for both. Rounding.
constexpr double kDeeper = 1e-12;
// Barycentric weight (1): with less of a corner, a point is on the edge across. Rounding.
constexpr double kOnEdge = 1e-9;
// m: nearer to a mesh, the direction from its nearest point is noise; the face's normal counts.
constexpr double kOnSurface = 1e-10;
// Of the distance to a mesh (1): with less height over the nearest face, a ray tells inside from
// outside. More: more rays, slower; less: noise decides.
constexpr double kPlainSide = 1e-6;
// How far a rotation may be from one (1); beyond, a link has no pose and touches nothing. More:
// shapes are slightly sheared; less: poses rounded by TF are refused. Chosen.
constexpr double kRigidSlack = 1e-6;

// How deep a shape is in the tissue: points of its surface, measured one by one.
// Points of a sphere, steps of a box's edge (edges of a mesh that are no longer than such a step of
// its longest side have no point in their middle), points around a cylinder, rings along its side
// and from the middle of its ends to their rim. More: deep places between them are found, for as
// many distances more at each look. Chosen.
constexpr int kSpherePoints = 200;
constexpr int kBoxSteps = 8;
constexpr int kRimPoints = 16;
constexpr int kSideRings = 8;
constexpr int kCapRings = 2;
// Moves from the deepest point to the shape's farthest along the way in, at most. More: deeper by
// little, as a few moves meet the end. Chosen.
constexpr int kMostMoves = 8;
// Ways as of this look, so far is looked for the surface around a point that is outside: if it is
// farther, the point need not be looked at in so many looks. More: each of these looks costs more.
// Chosen.
constexpr double kLooksAhead = 8.0;
// Of the thickness (1): a move that brings less is the last. Less: more moves. Chosen.
constexpr double kLeastGain = 1e-5;

// Where a shape is, if no point of its surface tells.
// Faces of a mesh behind which the largest ball is sought, the largest faces first; one at least of
// each of its parts. More: points deeper inside, at loading only. Chosen.
constexpr std::size_t kInnerBalls = 32;
// Times that a ball shrinks, at most. More: deeper by little. Chosen.
constexpr int kMostShrinks = 24;
// Of a ball's radius (1): with the surface no nearer to its middle, it touches all around. Less: it
// shrinks less often, and is a little off the deepest place. Chosen.
constexpr double kFillsBall = 0.999;

// The tree over the tissue's surface.
// Triangles of one of its parts, at most the greater of these two: a number, and all over so many
// parts. More triangles a part: fewer boxes are made anew at each look, but more where a tool is.
// With 24 and 64 of 12,800 a search takes the same time (test/benchmark/contact_search).
constexpr int kTrianglesOfPart = 24;
constexpr int kParts = 256;

// Beside a mesh.
// Of the margin of a search (1): so much farther pairs of triangles are kept for the next ones.
// More: they serve for more searches, and each looks at more of them. 0.5, 1, 2: three fingers,
// 0.25 mm an update, take 1, 0.96, 0.96 of the time, two of them 1, 0.99, 1.01.
constexpr double kPairsAhead = 1.0;

// Flat faces.
// Cosine of the angle by which a mesh folds at the edge of a face (1): 40 degrees. Less: fewer
// edges are sharp. Chosen.
constexpr double kSharpEdge = 0.766;
// Of its longest side (1): a triangle of a mesh that is lower is no face, as fillers between
// vertices that do not meet are. Less: these end the faces around them; more: long narrow faces are
// none. Chosen: a micrometer on 10 mm.
constexpr double kSliver = 1e-4;
// Cosine between a flat face and where its link presses to (1): 35 degrees. Less: more tilted faces
// are looked at. Chosen.
constexpr double kFaces = 0.819;
// Cosine between two edges of a face that bound it on different sides (1): 60 degrees. More:
// rounded outlines have several edges near to each other. Chosen.
constexpr double kOtherSide = 0.5;
// Of the reach in which edges are looked for (1), itself 2.5 spacings: a length that the lattice
// can feel. A face that goes on so far beyond an edge does not end there. More: wider gaps between
// shapes, and grooves, are none. Chosen: a fifth of the spacing.
constexpr double kFeltOfReach = 0.08;
// Sine of the angle by which what is beyond an edge must turn away from the face (1): 30 degrees,
// less than a mesh folds at a sharp edge. More: shapes that are joined aslant, or with a step, are
// one face. Chosen.
constexpr double kTurnsAway = 0.5;
// Of that length (1): a narrow shape so near beyond an edge goes on with the face, too. Chosen.
constexpr double kJustBeyond = 0.25;
// Cosine between an edge and one farther on in the face of the shape that goes on there (1): this
// one is seen past the first. Above rounding; more: edges aslant to each other are not seen.
constexpr double kSameWay = 0.1;

// Others.
// Of the clearance that is sought (1): the shortest step along a direction out of a shape. More:
// fewer steps, and the way out is too long by up to as much; less: slow where it grazes. Chosen.
constexpr double kLeastStep = 0.1;
// Units of FCL in a meter: libccd's tolerances are absolute and made for shapes about one unit
// wide. With 1, gaps would be wrong by micrometers; far more, and large shapes are. Chosen.
constexpr double kUnitsPerM = 100.0;
// m: gaps that are so much wider than is asked for are not measured. Less: where gaps are as wide
// as that, rounding may tell them wider; more: more is measured. Rounding.
constexpr double kBeyondReach = 1e-9;
// Directions in which a mesh's thickness is measured, at most. More: thin places are found surely,
// at loading only. Chosen.
constexpr std::size_t kWidthDirections = 400;

// Extents of the tissue (1): a link that is larger was drawn in another unit. Chosen.
constexpr double kLargestTool = 10.0;

// Of a cylinder as what it presses on sees it: 64 are 0.1 % of its radius inside it.
constexpr int kSidesOfCylinder = 64;

}  // namespace robot_tissue::tuning
