#include "src/scene/affine_map.h"

#include <cmath>

namespace sheaf {
namespace {

double Cofactor(const AffineMap& m, int i, int j) {
  const auto at = [&](int row, int column) { return m.row[(i + row) % 3][(j + column) % 3]; };
  return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
}

}  // namespace

AffineMap MapOf(const Transform& transform) {
  AffineMap map;
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) map.row[i][axis] = transform.linear[axis][i];
    map.row[i][3] = transform.translation[i];
  }
  return map;
}

AffineMap InverseOf(const AffineMap& map) {
  AffineMap inverse;
  double determinant = 0;
  for (int j = 0; j < 3; ++j) determinant += map.row[0][j] * Cofactor(map, 0, j);
  for (int i = 0; i < 3; ++i) {
    double moved = 0;
    for (int j = 0; j < 3; ++j) {
      inverse.row[i][j] = Cofactor(map, j, i) / determinant;
      moved += inverse.row[i][j] * map.row[j][3];
    }
    inverse.row[i][3] = -moved;
  }
  return inverse;
}

double ConditionOf(const AffineMap& map, const AffineMap& inverse) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) sum += std::abs(map.row[i][k]) * std::abs(inverse.row[k][j]);
    }
    // A NaN stays.
    if (!(sum <= largest)) largest = sum;
  }
  return largest;
}

std::string FaultOf(const AffineMap& to_world) {
  for (const auto& row : to_world.row) {
    for (const double x : row) {
      if (!std::isfinite(x)) return "a number of its transform is not finite";
    }
  }
  // False for the NaN of a determinant of 0.
  if (!(ConditionOf(to_world, InverseOf(to_world)) <= kMaxCondition)) {
    return "its transform flattens it";
  }
  return "";
}

}  // namespace sheaf
