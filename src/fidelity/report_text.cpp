#include "report_text.h"

#include <algorithm>
#include <cstdio>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kMm = 1e3;

std::string digits(double value, int significant) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.*g", significant, value);
  return text;
}

// Above 100 % an estimate says no more than that nothing has converged.
std::string percent(double share) {
  return share > 1.0 ? "> 100 %" : digits(1e2 * share, 3) + " %";
}

std::string mm(double length) { return digits(kMm * length, 4) + " mm"; }

// Words in columns that line up, two blanks between.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line += std::string(widths[i] - row[i].size() + 2, ' ');
    }
    text += line + '\n';
  }
  return text;
}

std::vector<std::string> cellsOf(const Assessed& row, bool error_known) {
  std::vector<std::string> cells = {"elastic", row.rung.method, mm(row.rung.spacing)};
  if (!row.gap.empty()) {
    cells.insert(cells.end(), {"-", digits(row.rung.tolerance, 4), row.gap});
    return cells;
  }
  cells.insert(cells.end(), {std::to_string(row.nodes), digits(row.rung.tolerance, 4)});
  for (const double share : {row.error(), row.field_error, row.force_error, row.solver_error}) {
    cells.push_back(error_known ? percent(share) : "unknown");
  }
  cells.insert(cells.end(), {digits(row.median_ms, 3), digits(row.greatest_ms, 3),
                             digits(row.rate(), 3), toString(row.worst)});
  return cells;
}

}  // namespace

std::string tableText(const Assessment& assessment) {
  std::vector<std::vector<std::string>> rows = {{"model", "method", "spacing", "nodes", "tolerance",
                                                 "error", "displacement", "force", "of it solver",
                                                 "ms/update", "slowest", "updates/s", "status"}};
  for (const Assessed& row : assessment.rows) {
    rows.push_back(cellsOf(row, assessment.lattices > 1));
  }
  rows.push_back({"six_spring", "paper", "-", "-", "-",
                  "not estimable: it has no unique equilibrium, nothing to converge to"});
  return aligned(rows);
}

std::string tableCsv(const Assessment& assessment) {
  std::string csv =
      "model,method,spacing,nodes,tolerance,error,field_error,force_error,solver_error,median_ms,"
      "greatest_ms,status\n";
  for (const Assessed& row : assessment.rows) {
    csv += "elastic," + row.rung.method + ',' + numberText(row.rung.spacing) + ',' +
           std::to_string(row.nodes) + ',' + numberText(row.rung.tolerance) + ',';
    if (row.gap.empty() && assessment.lattices > 1) {
      for (const double share : {row.error(), row.field_error, row.force_error, row.solver_error}) {
        csv += numberText(share) + ',';
      }
    } else {
      csv += ",,,,";
    }
    csv += row.gap.empty() ? numberText(row.median_ms) + ',' + numberText(row.greatest_ms) + ',' +
                                 toString(row.worst)
                           : ",,NOT_TRIED";
    csv += '\n';
  }
  return csv;
}

std::string limitText(const Assessment& assessment) {
  if (assessment.lattices < 2) {
    return "error unknown: it takes at least two lattices that solve the scene; give --seconds "
           "more, or a spacing that others fit beside\n";
  }
  std::string text = "errors are against the limit of the " + std::to_string(assessment.lattices) +
                     " finest lattices at " + std::to_string(assessment.points) + " points\n";
  if (assessment.lattices == 2) {
    return text +
           "two lattices do not tell how fast the error falls: first order is assumed, too "
           "slow where all is smooth, so errors may be overstated\n";
  }
  const auto order = [](const Limit& limit) {
    const std::string seen = "order " + digits(limit.observed, 2);
    return limit.order == limit.observed ? seen : seen + ", taken as " + digits(limit.order, 2);
  };
  text += "with the spacing falls the displacements' error by " + order(assessment.field) +
          "; the forces' by " + order(assessment.force) + '\n';
  if (std::min(assessment.field.observed, assessment.force.observed) < kLowestOrder) {
    text +=
        "below order " + digits(kLowestOrder, 2) +
        " answers do not approach a limit regularly: errors are rough, finer lattices tell more "
        "(--seconds)\n";
  }
  return text;
}

std::string rungText(const Assessed& row) {
  return "elastic, " + row.rung.method + ", spacing " + mm(row.rung.spacing) + ", tolerance " +
         digits(row.rung.tolerance, 4) + ": error " + percent(row.error()) + ", " +
         digits(row.median_ms, 3) + " ms an update (" + digits(row.rate(), 3) + " a second)";
}

std::string choiceText(const Assessment& assessment, const Choice& choice, double error,
                       double rate) {
  const std::string wish = percent(error) + " and " + digits(rate, 4) + " updates a second";
  const auto& rows = assessment.rows;
  if (assessment.lattices < 2) return "none can be named for " + wish + '\n';
  if (choice.best) {
    return "cheapest within " + wish + ":\n  " + rungText(rows[*choice.best]) + '\n';
  }
  std::string text = "none meets " + wish + '\n';
  if (!choice.nearest) return text + "no lattice solved all increments\n";
  text += "nearest:\n  " + rungText(rows[*choice.nearest]) + '\n';
  text += "fastest within " + percent(error) + ":\n  " +
          (choice.fastest ? rungText(rows[*choice.fastest]) : "none") + '\n';
  text += "least error at " + digits(rate, 4) + " updates a second:\n  " +
          (choice.most_accurate ? rungText(rows[*choice.most_accurate]) : "none") + '\n';
  return text;
}

std::string progressText(std::size_t done, std::size_t all, const Rung& rung, int update,
                         int updates) {
  constexpr std::size_t kWidth = 20;
  const std::size_t filled = all > 0 ? kWidth * done / all : kWidth;
  return "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " +
         std::to_string(done + 1) + " of " + std::to_string(all) + ": " + mm(rung.spacing) +
         ", tolerance " + digits(rung.tolerance, 4) + ", update " + std::to_string(update) +
         " of " + std::to_string(updates);
}

}  // namespace robot_tissue
