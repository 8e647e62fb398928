// The numbers of methods `vbd`, `xpbd` and `explicit` in one place: unit, where each comes from,
// and what turning it does. "spacing" is the lattice's; a "look" is a comparison of the shape with
// that some iterations ago, a "way" the distance between the two (L2), the "motion left" what would
// balance each node alone. Chosen: by judgment, and kept as the tests and the comparison
// (doc/baselines.md) passed; no other value was measured against it.
#pragma once

namespace robot_tissue::tuning {

// All three: when a solve ends.
// Of the spacing (1): a node off rest by less is at rest. More: displacements that small are solved
// less well. Chosen.
constexpr double kStill = 1e-6;
// Of the spacing, a node (1): motion left that is single precision's rounding (doc/baselines.md).
// More: ends early; less: solves of small loads never end.
constexpr double kRounding = 3e-7;
// Of the spacing, a node (1): displacements so small end as balanced where the motion left is
// rounding. More: larger ones end less exact (doc/baselines.md).
constexpr double kTiny = 1e-3;
// Of the motion left at the end of the last solve (1): up to it, the same shape is as it was left,
// and keeps its error. Rounding.
constexpr double kSame = 1.001;
// Of the way still to go were ways shrinking as in the end (1): the estimate is no less. More:
// safer estimates, more iterations. Chosen: doc/baselines.md.
constexpr double kShareOfEnd = 0.5;
// Of a node's stiffness (1): the slowest wave that is taken as seen. Less: more patience with what
// seems not to move. Chosen.
constexpr double kLeastWave = 1e-6;

// All three: when a solve goes astray.
// Of the least motion left so far (1): beyond, the best shape comes back and the method goes on
// with more care. More: real blows are found later; less: care where none is needed. Chosen.
constexpr double kGrown = 10.0;
// Looks without a better shape, for the same. More: later; less: slow solves are taken for stuck.
// Chosen.
constexpr int kPatience = 100;
// Times that care is added before the solve is given up. More: hopeless solves take longer. Chosen.
constexpr int kMostCare = 6;
// Looks from one look at the forces to the next, which costs as much as an iteration. More: faster
// where all is well, later where it is not. Chosen.
constexpr int kLooksApart = 4;

// Iterations of a load step in contact beyond which it is a hard one. A sphere that is pressed into
// a block of cells of 10 mm and dragged takes 27, 990 and 86 a solve. More: jams are followed for
// longer. Chosen.
constexpr int kUsualOfVbd = 150;
constexpr int kUsualOfXpbd = 2000;
constexpr int kUsualOfExplicit = 600;

// Patches by force.
// Spacings: motion that measures a patch's stiffness. More: the stiffness of a bent way; less:
// rounding. Chosen.
constexpr double kPatchProbe = 1e-4;
// Spacings, rad: the most that a patch moves and turns in one iteration. More: faster on long ways,
// cells beside it may turn inside out. Chosen.
constexpr double kPatchStep = 0.5;
constexpr double kPatchTurn = 0.2;

// Cells and nodes.
// Determinant of a corner (1) below which a cell is watched for the barrier: it may be reached
// before it is looked at again. More: more cells done in double precision; less: surprises. Chosen.
constexpr float kSoonSqueezed = 0.4F;
// Of a node's stiffest direction (1): its others count as no less stiff. More: shorter, safer steps
// of squeezed nodes. Chosen.
constexpr double kSoftest = 0.05;

// `vbd`.
// Of the radius that leaves as much of the slowest wave as of the complex eigenvalues (1), for
// Chebyshev's method. More: faster on an endless lattice, astray on real ones (doc/baselines.md).
constexpr double kOfBest = 0.97;
// Over-relaxation is 2 / (1 + slack / depth): slack at Poisson's ratio 0.25, and what each 1 of the
// ratio beyond adds. Less: nearer to 2, faster until it goes astray. From waves in an endless
// lattice: doc/baselines.md.
constexpr double kSlack = 1.75;
constexpr double kSlackOfRatio = 3.75;

// `xpbd`. The stretch is the square of the time step times a node's stiffness over its mass; the
// shape at the end is off in proportion to it (measured: doc/baselines.md).
// Over the tolerance (1): the first. More: fast at first, more refinements later. Chosen.
constexpr double kFirstStretch = 8.0;
// At most and at least (1). More at most: rough loads go astray. Less at least: nearer to balance,
// until rounding stops it. Chosen.
constexpr double kMostStretch = 0.3;
constexpr double kLeastStretch = 1e-4;
// In a time step, over the tolerance (1): of the small steps. More: fewer, softer and with more
// damping of their own. Chosen.
constexpr double kStretchInTime = 0.5;
// From one to the next (1). More: smaller changes, better estimates, more of them. Chosen.
constexpr double kShorter = 0.25;
// Of the way since the last change (1): what may be left to go before the next. More: changes
// sooner, with a worse estimate of what the last one brought. Chosen.
constexpr double kSettled = 0.2;

// `explicit`.
// Steps from one look at the nodes' masses to the next. More: cheaper, unstable where tissue
// stiffens fast. Chosen.
constexpr int kWeighings = 16;
// Spacings: the most that a node moves in one step. Less: rough loads take longer; more: cells turn
// inside out. Chosen.
constexpr double kMostStep = 0.25;
// Iterations for the greatest eigenvalue, where other nodes are held than before. More: closer to
// it by as many evaluations of all forces. Chosen.
constexpr int kPowers = 12;
// Spacings: the motion that they start with. More: the eigenvalue of a bent way; less: rounding.
// Chosen.
constexpr double kPowerProbe = 1e-2;
// Over what they find (1), which is a little less than the greatest. Less: longer steps, which may
// blow up. Chosen.
constexpr double kMargin = 1.15;
// Of the longest stable step of a motion in time (1), as stiffness grows with strain. More: fewer
// steps, which may blow up. Chosen.
constexpr double kOfStable = 0.9;
// Over the eigenvalue when the motion went astray (1). More: surer, slower. Chosen.
constexpr double kCare = 1.5;

}  // namespace robot_tissue::tuning
