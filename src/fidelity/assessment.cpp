#include "assessment.h"

#include <algorithm>
#include <map>

#include "tuning.h"

namespace robot_tissue {
namespace {

std::vector<std::uint8_t> heldByAll(const std::vector<Trial>& trials) {
  std::vector<std::uint8_t> held;
  for (const Trial& trial : trials) {
    if (!trial.gap.empty()) continue;
    for (const Field& field : trial.fields) {
      if (held.empty()) held.assign(field.inside.size(), 1);
      for (std::size_t i = 0; i < held.size(); ++i) held[i] &= field.inside[i];
    }
  }
  return held;
}

// Displacements of all steps at the points, one below the other.
Eigen::VectorXd flat(const std::vector<Field>& fields, const std::vector<std::uint8_t>& held) {
  const auto points = static_cast<Eigen::Index>(std::count(held.begin(), held.end(), 1));
  Eigen::VectorXd values(3 * points * static_cast<Eigen::Index>(fields.size()));
  Eigen::Index row = 0;
  for (const Field& field : fields) {
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (held[i] == 0) continue;
      values.segment<3>(row) = field.displacement[i];
      row += 3;
    }
  }
  return values;
}

Eigen::VectorXd flat(const std::vector<Vec3>& forces) {
  Eigen::VectorXd values(3 * static_cast<Eigen::Index>(forces.size()));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    values.segment<3>(3 * static_cast<Eigen::Index>(i)) = forces[i];
  }
  return values;
}

// Greatest norm of the parts of equal length.
double greatestPart(const Eigen::VectorXd& values, Eigen::Index part) {
  double greatest = 0.0;
  for (Eigen::Index row = 0; part > 0 && row + part <= values.size(); row += part) {
    greatest = std::max(greatest, values.segment(row, part).norm());
  }
  return greatest;
}

// What is compared of a trial.
struct Answer {
  Eigen::VectorXd field;  // m
  Eigen::VectorXd force;  // N
};

class Assessor {
 public:
  explicit Assessor(const std::vector<Trial>& trials) : trials_(trials), held_(heldByAll(trials)) {
    for (const Trial& trial : trials) {
      answers_.push_back({flat(trial.fields, held_), flat(trial.forces)});
    }
    findTightest();
  }

  Assessment assess() {
    Assessment result;
    result.points = static_cast<std::size_t>(std::count(held_.begin(), held_.end(), 1));
    findLimit(result);
    for (std::size_t i = 0; i < trials_.size(); ++i) result.rows.push_back(rowOf(i, result));
    return result;
  }

 private:
  // Spacings rise in a map: the finest is the first.
  void findTightest() {
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const Trial& trial = trials_[i];
      if (!trial.gap.empty() || trial.worst != SolveStatus::kOk) continue;
      const auto found = tightest_.try_emplace(trial.rung.spacing, i).first;
      if (trial.rung.tolerance < trials_[found->second].rung.tolerance) found->second = i;
    }
  }

  void findLimit(Assessment& result) {
    std::vector<Sample> fields, forces;
    for (const auto& [spacing, index] : tightest_) {
      if (fields.size() == tuning::kMostSamples) break;
      fields.insert(fields.begin(), {spacing, answers_[index].field});
      forces.insert(forces.begin(), {spacing, answers_[index].force});
    }
    result.lattices = static_cast<int>(fields.size());
    if (fields.size() < 2) return;
    result.field = limitOf(fields);
    result.force = limitOf(forces);
    const auto steps = static_cast<Eigen::Index>(trials_[tightest_.begin()->second].fields.size());
    step_rows_ = steps > 0 ? result.field.value.size() / steps : 0;
    field_scale_ = greatestPart(result.field.value, step_rows_);
    force_scale_ = greatestPart(result.force.value, 3);
    if (!(field_scale_ > 0.0)) {
      throw InputError(
          "the scene's steps end with nothing moved: must have one that moves the "
          "tissue and leaves it so");
    }
  }

  // Relative distances; with them `other` may be the limit or another answer.
  double fieldDistance(const Answer& answer, const Eigen::VectorXd& other) const {
    return greatestPart(answer.field - other, step_rows_) / field_scale_;
  }
  double forceDistance(const Answer& answer, const Eigen::VectorXd& other) const {
    return force_scale_ > 0.0 ? greatestPart(answer.force - other, 3) / force_scale_ : 0.0;
  }

  Assessed rowOf(std::size_t index, const Assessment& result) const {
    const Trial& trial = trials_[index];
    Assessed row{trial.rung, trial.gap, trial.nodes, trial.worst};
    if (!row.gap.empty()) return row;
    std::vector<double> ms = trial.update_ms;
    if (!ms.empty()) {
      const auto middle = ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2);
      std::nth_element(ms.begin(), middle, ms.end());
      row.median_ms = *middle;
      row.greatest_ms = *std::max_element(ms.begin(), ms.end());
    }
    if (result.lattices < 2) return row;
    const Answer& answer = answers_[index];
    row.field_error = fieldDistance(answer, result.field.value);
    row.force_error = forceDistance(answer, result.force.value);
    const auto tightest = tightest_.find(trial.rung.spacing);
    if (tightest != tightest_.end()) {
      const Answer& best = answers_[tightest->second];
      row.solver_error =
          std::max(fieldDistance(answer, best.field), forceDistance(answer, best.force));
    }
    return row;
  }

  const std::vector<Trial>& trials_;
  std::vector<std::uint8_t> held_;          // points that every trial's lattice holds
  std::vector<Answer> answers_;             // per trial
  std::map<double, std::size_t> tightest_;  // trial of the least tolerance at each spacing
  Eigen::Index step_rows_ = 0;              // of a field at the end of one step
  double field_scale_ = 0.0;
  double force_scale_ = 0.0;
};

// Takes the row where it is better, i.e. `value` smaller.
class Least {
 public:
  void offer(std::size_t row, double value) {
    if (row_ && !(value < value_)) return;
    row_ = row;
    value_ = value;
  }
  std::optional<std::size_t> row() const { return row_; }

 private:
  std::optional<std::size_t> row_;
  double value_ = 0.0;
};

}  // namespace

Assessment assessed(const std::vector<Trial>& trials) { return Assessor(trials).assess(); }

Choice choose(const std::vector<Assessed>& rows, double error, double rate) {
  Least best, nearest, fastest, most_accurate;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Assessed& row = rows[i];
    if (!row.usable()) continue;
    const bool near_enough = row.error() <= error;
    const bool fast_enough = row.rate() >= rate;
    if (near_enough && fast_enough) best.offer(i, row.median_ms);
    if (near_enough) fastest.offer(i, row.median_ms);
    if (fast_enough) most_accurate.offer(i, row.error());
    nearest.offer(i, std::max(row.error() / error, rate / row.rate()));
  }
  return {best.row(), nearest.row(), fastest.row(), most_accurate.row()};
}

}  // namespace robot_tissue
