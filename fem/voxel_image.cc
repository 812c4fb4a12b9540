#include "fem/voxel_image.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace densify::fem {

namespace {

int wrapped(int k, int n) {
  k %= n;
  return k < 0 ? k + n : k;
}

}  // namespace

double VoxelImage::solid_fraction() const {
  return double(std::count_if(phase.begin(), phase.end(), [](auto p) { return p != 0; })) / double(phase.size());
}

LevelSet::LevelSet(const Mat3& cell, std::array<int, 3> n, double reach) : to_fraction_(cell.inverse()), reach_(reach) {
  const std::size_t size = std::size_t(n[0]) * n[1] * n[2];
  shape_ = {cell, n, std::vector<std::uint8_t>(size, 1)};
  distance_.assign(size, std::numeric_limits<float>::infinity());
}

template <class Distance>
void LevelSet::draw(const Vec3& middle, double half, std::uint8_t material, Distance distance) {
  const auto& n = shape_.n;
  const Vec3 f = to_fraction_ * middle;
  std::array<int, 3> low, high;
  for (int c = 0; c < 3; ++c) {
    const double w = half * to_fraction_.row(c).norm();
    low[c] = int(std::ceil((f[c] - w) * n[c] - 0.5));
    high[c] = int(std::floor((f[c] + w) * n[c] - 0.5));
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const Vec3 at = shape_.cell * Vec3((x + 0.5) / n[0], (y + 0.5) / n[1], (z + 0.5) / n[2]);
        const float d = float(distance(at));
        if (d > reach_) continue;
        const std::size_t k = shape_.at(wrapped(x, n[0]), wrapped(y, n[1]), wrapped(z, n[2]));
        if (d >= distance_[k]) continue;
        distance_[k] = d;
        shape_.phase[k] = std::uint8_t(material + 1);
      }
}

void LevelSet::add(const Ball& b) {
  draw(b.centre, b.radius + reach_, b.material, [&](const Vec3& at) { return (at - b.centre).norm() - b.radius; });
}

void LevelSet::add(const Rod& r) {
  const double length = r.branch.squaredNorm();
  draw(r.start + 0.5 * r.branch, 0.5 * r.branch.norm() + r.radius + reach_, r.material, [&](const Vec3& at) {
    const double share = std::clamp((at - r.start).dot(r.branch) / length, 0.0, 1.0);
    return (at - r.start - share * r.branch).norm() - r.radius;
  });
}

double LevelSet::fraction(double shift) const {
  return double(std::count_if(distance_.begin(), distance_.end(), [=](float d) { return d <= shift; })) /
         double(distance_.size());
}

double LevelSet::shift_for(double fraction) const {
  auto sorted = distance_;
  const auto count = std::size_t(std::lround(fraction * double(sorted.size())));
  if (count == 0) return -std::numeric_limits<double>::infinity();
  const auto last = sorted.begin() + std::ptrdiff_t(std::min(count, sorted.size()) - 1);
  std::nth_element(sorted.begin(), last, sorted.end());
  if (!std::isfinite(*last))
    throw InputError("a solid fraction of " + std::to_string(fraction) + " needs bodies grown by more than " +
                     std::to_string(reach_) + " m, farther than any voxel was looked at");
  return *last;
}

VoxelImage LevelSet::body(double shift) const {
  VoxelImage image = shape_;
  for (std::size_t k = 0; k < image.size(); ++k)
    if (!(distance_[k] <= shift)) image.phase[k] = 0;
  return image;
}

VoxelImage LevelSet::complement(double shift) const {
  VoxelImage image = shape_;
  for (std::size_t k = 0; k < image.size(); ++k) image.phase[k] = distance_[k] > shift ? 1 : 0;
  return image;
}

LooseVoxels remove_loose(VoxelImage& image) {
  // As in a contact network: every voxel of a body gets its place relative to the first, and a face that does not fit
  // leads around the cell.
  const auto n = image.n;
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> body(image.size(), none);
  std::vector<Eigen::Vector3i> place(image.size());
  std::vector<bool> keep;
  std::vector<std::uint32_t> members;
  for (std::size_t first = 0; first < image.size(); ++first) {
    if (image.phase[first] == 0 || body[first] != none) continue;
    const auto name = std::uint32_t(keep.size());
    body[first] = name;
    place[first] = {int(first % n[0]), int(first / n[0] % n[1]), int(first / n[0] / n[1])};
    members = {std::uint32_t(first)};
    Mat3 around = Mat3::Zero();
    for (std::size_t m = 0; m < members.size(); ++m)
      for (int c = 0; c < 3; ++c)
        for (const int way : {-1, 1}) {
          Eigen::Vector3i to = place[members[m]];
          to[c] += way;
          const auto k = std::uint32_t(image.at(wrapped(to[0], n[0]), wrapped(to[1], n[1]), wrapped(to[2], n[2])));
          if (image.phase[k] == 0) continue;
          if (body[k] == none) {
            body[k] = name;
            place[k] = to;
            members.push_back(k);
          } else {
            const Vec3 w = (to - place[k]).cast<double>();
            if (to != place[k]) around += w * w.transpose() / w.squaredNorm();
          }
        }
    Eigen::FullPivLU<Mat3> rank(around);
    rank.setThreshold(1e-9);
    keep.push_back(rank.rank() == 3);
  }
  LooseVoxels out;
  for (const bool k : keep) out.spans = out.spans || k;
  for (std::size_t k = 0; k < image.size(); ++k)
    if (image.phase[k] != 0 && !keep[body[k]]) image.phase[k] = 0, ++out.removed;
  return out;
}

}  // namespace densify::fem
