#include "result_text.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace robot_tissue {
namespace {

constexpr std::size_t kStlHeaderBytes = 80;

std::string text(double value) {
  if (!std::isfinite(value))
    throw std::runtime_error("the solver gave a number that is not finite");
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.17g", value);
  return digits;
}

std::string text(const Vec3& value) {
  return text(value.x()) + ',' + text(value.y()) + ',' + text(value.z());
}

std::string text(int step, int increment) {
  return std::to_string(step) + ',' + std::to_string(increment);
}

// STL is little-endian on every machine.
void appendLittleEndian(std::string& bytes, std::uint32_t value, int count) {
  for (int byte = 0; byte < count; ++byte) {
    bytes += static_cast<char>(static_cast<unsigned char>(value >> (8 * byte) & 0xFFU));
  }
}

void appendFloats(std::string& bytes, const Vec3& value) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(value[axis]) <= std::numeric_limits<float>::max())) {
      throw std::runtime_error("a vertex of the surface is beyond the numbers that STL holds");
    }
    const float number = static_cast<float>(value[axis]);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof(bits));
    appendLittleEndian(bytes, bits, 4);
  }
}

}  // namespace

std::string nodesCsv(const RunResult& result) {
  std::string csv = "x,y,z,ux,uy,uz\n";
  for (std::size_t node = 0; node < result.rest.size(); ++node) {
    csv += text(result.rest[node]) + ',' + text(result.displacement[node]) + '\n';
  }
  return csv;
}

std::string patchesCsv(const RunResult& result) {
  std::string csv = "step,increment,patch,fx,fy,fz,ux,uy,uz\n";
  for (const PatchRow& row : result.patches) {
    csv += text(row.step, row.increment) + ',' + row.patch + ',' + text(row.answer.force) + ',' +
           text(row.answer.displacement) + '\n';
  }
  return csv;
}

std::string incrementsCsv(const RunResult& result) {
  std::string csv =
      "step,increment,status,wall_ms,iterations,residual,error_estimate,active_nodes,layers,"
      "volume_ratio,inverted_cells,update_ms,time\n";
  for (const IncrementRow& row : result.increments) {
    const SolveReport& report = row.report;
    csv += text(row.step, row.increment) + ',' + toString(report.status) + ',' +
           text(report.wall_ms) + ',' + std::to_string(report.iterations) + ',' +
           text(report.residual) + ',' + text(report.error_estimate) + ',' +
           std::to_string(report.active_nodes) + ',' + std::to_string(report.layers) + ',' +
           text(report.volume_ratio) + ',' + std::to_string(report.inverted_cells) + ',' +
           text(row.update_ms) + ',' + text(row.time) + '\n';
  }
  return csv;
}

std::string toolsCsv(const RunResult& result) {
  std::string csv = "step,increment,tool,fx,fy,fz,tx,ty,tz,contacts,max_penetration\n";
  for (const ToolRow& row : result.tools) {
    csv += text(row.step, row.increment) + ',' + row.tool + ',' + text(row.force) + ',' +
           text(row.torque) + ',' + std::to_string(row.contacts) + ',' + text(row.max_penetration) +
           '\n';
  }
  return csv;
}

std::string piecesCsv(const RunResult& result) {
  std::string csv = "step,increment,piece,volume,fixed,cx,cy,cz\n";
  for (const PieceRow& row : result.pieces) {
    csv += text(row.step, row.increment) + ',' + std::to_string(row.piece.number) + ',' +
           text(row.piece.volume) + ',' + (row.piece.fixed ? '1' : '0') + ',' +
           text(row.piece.center) + '\n';
  }
  return csv;
}

std::string suturesCsv(const RunResult& result) {
  std::string csv = "step,increment,suture,tension,length,broken\n";
  for (const SutureRow& row : result.sutures) {
    csv += text(row.step, row.increment) + ',' + row.suture.name + ',' + text(row.suture.tension) +
           ',' + text(row.suture.length) + ',' + (row.suture.broken ? '1' : '0') + '\n';
  }
  return csv;
}

std::string surfaceStl(const RunResult& result) {
  std::string stl = "robot_tissue surface, m, tissue frame";
  stl.resize(kStlHeaderBytes, ' ');
  appendLittleEndian(stl, static_cast<std::uint32_t>(result.triangles.size()), 4);
  for (const auto& triangle : result.triangles) {
    const Vec3& a = result.vertices[static_cast<std::size_t>(triangle[0])];
    const Vec3& b = result.vertices[static_cast<std::size_t>(triangle[1])];
    const Vec3& c = result.vertices[static_cast<std::size_t>(triangle[2])];
    const Vec3 area = (b - a).cross(c - a);
    const double length = area.norm();
    appendFloats(stl, length > 0.0 ? Vec3(area / length) : Vec3(Vec3::Zero()));
    for (const Vec3& corner : {a, b, c}) appendFloats(stl, corner);
    appendLittleEndian(stl, 0, 2);  // attribute bytes, unused
  }
  return stl;
}

}  // namespace robot_tissue
