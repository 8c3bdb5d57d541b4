#include "src/lab/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sheaf {
namespace {

constexpr double kPi = std::numbers::pi;

// One channel of a picture.
struct Plane {
  int width, height;
  std::vector<double> values;

  Plane(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  // A pixel outside the picture has the value of the nearest pixel inside.
  double at(int x, int y) const {
    const int cx = std::clamp(x, 0, width - 1), cy = std::clamp(y, 0, height - 1);
    return values[static_cast<std::size_t>(cy) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(cx)];
  }
};

using Triple = std::array<double, 3>;
using Image = std::array<Plane, 3>;

// ---- Colour spaces, from linear sRGB ----

// XYZ of sRGB's white.
constexpr Triple kWhite = {0.950428545, 1.0, 1.088900371};

Triple ToXyz(const Triple& rgb) {
  return {0.4123907993 * rgb[0] + 0.3575843394 * rgb[1] + 0.1804807884 * rgb[2],
          0.2126390059 * rgb[0] + 0.7151686788 * rgb[1] + 0.0721923154 * rgb[2],
          0.0193308187 * rgb[0] + 0.1191947798 * rgb[1] + 0.9505321522 * rgb[2]};
}

Triple ToRgb(const Triple& xyz) {
  return {3.2409699419 * xyz[0] - 1.5373831776 * xyz[1] - 0.4986107603 * xyz[2],
          -0.9692436363 * xyz[0] + 1.8759675015 * xyz[1] + 0.0415550574 * xyz[2],
          0.0556300797 * xyz[0] - 0.2039769589 * xyz[1] + 1.0569715142 * xyz[2]};
}

// YCxCz, the paper's opponent space: lightness, red against green, blue against yellow. It is
// CIELAB without the cube root, so that filtering stays linear.
Triple ToOpponent(const Triple& rgb) {
  const Triple xyz = ToXyz(rgb);
  const double x = xyz[0] / kWhite[0], y = xyz[1] / kWhite[1], z = xyz[2] / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple FromOpponent(const Triple& opponent) {
  const double y = (opponent[0] + 16) / 116;
  return ToRgb(
      {kWhite[0] * (y + opponent[1] / 500), kWhite[1] * y, kWhite[2] * (y - opponent[2] / 200)});
}

// CIELAB with chroma scaled by lightness. That is Hunt's effect: dark colours look less colourful.
Triple ToHuntLab(const Triple& rgb) {
  const Triple xyz = ToXyz(rgb);
  constexpr double kDelta = 6.0 / 29;
  Triple f;
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / kWhite[i];
    f[i] = t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  }
  const double lightness = 116 * f[1] - 16;
  return {lightness, 0.01 * lightness * 500 * (f[0] - f[1]),
          0.01 * lightness * 200 * (f[1] - f[2])};
}

// The HyAB distance of Abasi et al. (2020): city-block in lightness, Euclidean in chroma. It suits
// large differences of colour better than a Euclidean distance.
double HyAb(const Triple& a, const Triple& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// ---- Separable filters ----

using Kernel = std::vector<double>;  // values at -radius .. radius

// Filters rows with `across`, then columns with `down`.
Plane Convolve(const Plane& plane, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size() / 2);
  Plane rows(plane.width, plane.height), result(plane.width, plane.height);
  const auto filter = [radius](const Plane& from, const Kernel& kernel, int dx, int dy, Plane& to) {
    std::size_t pixel = 0;
    for (int y = 0; y < from.height; ++y) {
      for (int x = 0; x < from.width; ++x) {
        double sum = 0;
        for (int i = -radius; i <= radius; ++i) {
          sum += kernel[static_cast<std::size_t>(i + radius)] * from.at(x + i * dx, y + i * dy);
        }
        to.values[pixel++] = sum;
      }
    }
  };
  filter(plane, across, 1, 0, rows);
  filter(rows, down, 0, 1, result);
  return result;
}

// exp(-pi^2 d^2 / b) with d in degrees: the paper's Gaussian along one axis, without its factor
// sqrt(pi / b).
Kernel GaussianOfDegrees(double b, int radius, double pixels_per_degree) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) {
    const double d = i / pixels_per_degree;
    kernel.push_back(std::exp(-kPi * kPi * d * d / b));
  }
  return kernel;
}

double Sum(const Kernel& kernel) {
  double sum = 0;
  for (const double value : kernel) sum += value;
  return sum;
}

// Contrast sensitivity of the eye to Y, Cx and Cz: a1 Gaussian(b1) + a2 Gaussian(b2). From table 1
// of the paper.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[3] = {
    {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidest = 0.04;  // the largest b1

// What the eye resolves of one opponent channel.
Plane FilterBySensitivity(const Plane& plane, const Sensitivity& s, double pixels_per_degree) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
  Plane sum(plane.width, plane.height);
  double total = 0;
  const auto add = [&](double a, double b) {
    if (a == 0) return;
    const Kernel kernel = GaussianOfDegrees(b, radius, pixels_per_degree);
    const double scale = a * std::sqrt(kPi / b);
    const Plane part = Convolve(plane, kernel, kernel);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += scale * part.values[i];
    total += scale * Sum(kernel) * Sum(kernel);
  };
  add(s.a1, s.b1);
  add(s.a2, s.b2);
  for (double& value : sum.values) value /= total;
  return sum;
}

// ---- The error of colours, and that of features ----

// The film's pixels in opponent space, after clamping to [0, 1].
Image OpponentImage(const Film& film) {
  Image image = {Plane(film.width, film.height), Plane(film.width, film.height),
                 Plane(film.width, film.height)};
  for (std::size_t i = 0; i < image[0].values.size(); ++i) {
    Triple rgb;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double value = static_cast<double>(film.rgb[3 * i + channel]);
      rgb[channel] = value > 0 ? std::min(value, 1.0) : 0;  // NaN is 0
    }
    const Triple opponent = ToOpponent(rgb);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      image[channel].values[i] = opponent[channel];
    }
  }
  return image;
}

// The colours that the eye sees, blurred as it blurs them, in the space of HyAb.
std::vector<Triple> SeenColours(const Image& opponent, double pixels_per_degree) {
  Image seen = opponent;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    seen[channel] =
        FilterBySensitivity(opponent[channel], kSensitivities[channel], pixels_per_degree);
  }
  std::vector<Triple> colours;
  colours.reserve(seen[0].values.size());
  for (std::size_t i = 0; i < seen[0].values.size(); ++i) {
    Triple rgb = FromOpponent({seen[0].values[i], seen[1].values[i], seen[2].values[i]});
    for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
    colours.push_back(ToHuntLab(rgb));
  }
  return colours;
}

// The error of two seen colours, in [0, 1]. The exponent compresses large differences. Then two
// linear pieces meet at kBreak of the largest difference, where the error is kBreakValue.
double ColourError(const Triple& a, const Triple& b) {
  constexpr double kExponent = 0.7, kBreak = 0.4, kBreakValue = 0.95;
  static const double kLargest =
      std::pow(HyAb(ToHuntLab({0, 1, 0}), ToHuntLab({0, 0, 1})), kExponent);
  const double error = std::pow(HyAb(a, b), kExponent);
  const double at = kBreak * kLargest;
  if (error < at) return kBreakValue / at * error;
  return kBreakValue + (error - at) / (kLargest - at) * (1 - kBreakValue);
}

// How strong an edge or a point is at each pixel. A Gaussian's first derivative finds edges, its
// second derivative points.
struct Features {
  std::vector<double> edges, points;
};

// Scales a derivative so that its product with a Gaussian of sum `cross_sum` has positive values
// that sum to 1 and negative values that sum to -1. A flat picture then has no features.
void Balance(Kernel& derivative, double cross_sum) {
  double positive = 0, negative = 0;
  for (const double value : derivative) (value > 0 ? positive : negative) += value;
  for (double& value : derivative) {
    value /= (value > 0 ? positive : -negative) * cross_sum;
  }
}

Features FindFeatures(const Plane& lightness, double pixels_per_degree) {
  // The paper's features are 0.082 degrees wide.
  const double sd = 0.5 * 0.082 * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  Kernel gaussian, first, second;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-(i * i) / (2 * sd * sd));
    gaussian.push_back(g);
    first.push_back(-i * g);
    second.push_back((i * i / (sd * sd) - 1) * g);
  }
  Balance(first, Sum(gaussian));
  Balance(second, Sum(gaussian));
  const auto strength = [&](const Kernel& derivative) {
    const Plane across = Convolve(lightness, derivative, gaussian);
    const Plane down = Convolve(lightness, gaussian, derivative);
    std::vector<double> values;
    values.reserve(across.values.size());
    for (std::size_t i = 0; i < across.values.size(); ++i) {
      values.push_back(std::hypot(across.values[i], down.values[i]));
    }
    return values;
  };
  return {strength(first), strength(second)};
}

Features FeaturesOf(const Image& opponent, double pixels_per_degree) {
  Plane lightness = opponent[0];
  for (double& value : lightness.values) value = (value + 16) / 116;
  return FindFeatures(lightness, pixels_per_degree);
}

}  // namespace

std::vector<double> FlipErrors(const Film& reference, const Film& test, double pixels_per_degree) {
  const Image a = OpponentImage(reference), b = OpponentImage(test);
  const std::vector<Triple> colours_a = SeenColours(a, pixels_per_degree);
  const std::vector<Triple> colours_b = SeenColours(b, pixels_per_degree);
  const Features features_a = FeaturesOf(a, pixels_per_degree);
  const Features features_b = FeaturesOf(b, pixels_per_degree);
  std::vector<double> errors;
  errors.reserve(colours_a.size());
  for (std::size_t i = 0; i < colours_a.size(); ++i) {
    const double edge = std::abs(features_a.edges[i] - features_b.edges[i]);
    const double point = std::abs(features_a.points[i] - features_b.points[i]);
    // Raises the error of the colours where a feature is in one picture only.
    const double feature_error = std::sqrt(std::max(edge, point) / std::numbers::sqrt2);
    errors.push_back(std::pow(ColourError(colours_a[i], colours_b[i]), 1 - feature_error));
  }
  return errors;
}

double MeanFlip(const Film& reference, const Film& test, double pixels_per_degree) {
  double sum = 0;
  const std::vector<double> errors = FlipErrors(reference, test, pixels_per_degree);
  for (const double error : errors) sum += error;
  return sum / static_cast<double>(errors.size());
}

}  // namespace sheaf
