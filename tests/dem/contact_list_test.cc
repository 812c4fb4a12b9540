#include "dem/contact/contact_list.h"

#include <gtest/gtest.h>

#include "tests/support/setups.h"

namespace densify::dem {
namespace {

constexpr double r = 1;
const std::vector<double> cold{1.0};

Particles spheres(const std::vector<Vec3>& x) {
  Particles p;
  for (const Vec3& q : x) test::add_sphere(p, q, r, Vec3::Zero());
  return p;
}

Cell cube(double edge) {
  Cell c;
  c.periodic = true;
  c.h = edge * Mat3::Identity();
  return c;
}

constexpr HistoryNeeds both{true, true};

// A neck that has opened beyond the list's reach stays; a loose pair with a friction spring is dropped.
TEST(ContactList, NeckSurvivesAGap) {
  Particles p = spheres({{0, 0, 0}, {1.9, 0, 0}, {3.8, 0, 0}});
  ContactList list;
  list.skin = 0.2;
  rebuild(list, p, {}, cold, both, 1);
  ASSERT_EQ(list.size(), 2u);
  list.neck[0] = {0.3, -0.01, 5, NeckPhase::sintering};
  list.tangential[1] = Vec3(0, 0.1, 0);
  p.body[0].position[0] = -5;
  p.body[2].position[0] = 9;
  rebuild(list, p, {}, cold, both, 1);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.i(0), 0u);
  EXPECT_EQ(list.j(0), 1u);
  EXPECT_EQ(list.neck[0].radius, 0.3);
  EXPECT_EQ(list.neck[0].elastic, -0.01);
  EXPECT_EQ(list.neck[0].since, 5);
}

// Histories find their pair again after particles have crossed the faces of the cell, each way and each image.
TEST(ContactList, HistoriesFollowAcrossPeriodicFaces) {
  for (int k = 0; k < 3; ++k)
    for (double way : {-1.0, 1.0}) {
      Particles p = spheres({{5, 5, 5}, {5, 5, 5}, {1, 1, 1}});
      p.body[1].position[k] += 1.9;
      ContactList list;
      list.skin = 0.2;
      const Cell cell = cube(10);
      rebuild(list, p, cell, cold, both, 1);
      ASSERT_EQ(list.size(), 1u);
      list.neck[0] = {0.3, -0.01, 5, NeckPhase::bonded};
      list.tangential[0] = Vec3(0.01, 0.02, 0.03);
      for (int n = 0; n < 60; ++n) {  // a walk of 30 units: three times around the cell
        p.body[0].position[k] += 0.5 * way;
        p.body[1].position[k] += 0.5 * way;
        rebuild(list, p, cell, cold, both, 1);
        ASSERT_EQ(list.size(), 1u) << k << " " << way << " " << n;
        EXPECT_EQ(list.neck[0].radius, 0.3);
        EXPECT_EQ(list.tangential[0], Vec3(0.01, 0.02, 0.03));
        const Vec3 branch = p.body[1].position - p.body[0].position + cell.shift(list.image(0));
        EXPECT_NEAR(branch[k], 1.9, 1e-12);
      }
    }
}

// A particle that touches its own image keeps the history of that contact.
TEST(ContactList, OwnImage) {
  Particles p = spheres({{1, 1, 1}});
  ContactList list;
  list.skin = 0.1;
  Cell cell;
  cell.periodic = true;
  cell.h = Vec3(1.95, 5, 5).asDiagonal();
  rebuild(list, p, cell, cold, both, 1);
  ASSERT_EQ(list.size(), 1u);
  list.neck[0].phase = NeckPhase::bonded;
  list.neck[0].radius = 0.4;
  p.body[0].position[0] += 1.5;
  rebuild(list, p, cell, cold, both, 1);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.neck[0].radius, 0.4);
}

// Pairs lie in buckets of equal materials, ordered inside, and histories follow from bucket to bucket.
TEST(ContactList, BucketsByMaterials) {
  Particles p = spheres({{0, 0, 0}, {1.9, 0, 0}, {3.8, 0, 0}, {5.7, 0, 0}});
  p.material = {1, 0, 0, 1};
  ContactList list;
  list.skin = 0.2;
  rebuild(list, p, {}, {1.0, 1.0}, both, 1);
  ASSERT_EQ(list.buckets.size(), 2u);
  EXPECT_EQ(list.buckets[0].material_a, 0);
  EXPECT_EQ(list.buckets[0].material_b, 0);
  EXPECT_EQ(list.buckets[0].end - list.buckets[0].begin, 1u);
  EXPECT_EQ(list.buckets[1].material_b, 1);
  EXPECT_EQ(list.buckets[1].end - list.buckets[1].begin, 2u);
  EXPECT_EQ(list.i(0), 1u);
  list.neck[2] = {0.3, 0, 0, NeckPhase::bonded};
  rebuild(list, p, {}, {1.0, 1.0}, both, 1);
  EXPECT_EQ(list.neck[2].radius, 0.3);
  EXPECT_EQ(list.neck[0].phase, NeckPhase::loose);
}

// What a scene does not need has no array.
TEST(ContactList, NoArraysWithoutNeed) {
  Particles p = spheres({{0, 0, 0}, {1.9, 0, 0}});
  ContactList list;
  list.skin = 0.2;
  rebuild(list, p, {}, cold, {false, false}, 1);
  EXPECT_TRUE(list.neck.empty());
  EXPECT_TRUE(list.tangential.empty());
}

// Age: two particles may run half a skin each; growth counts over the largest diameter; a strained cell over the reach.
TEST(ContactList, Age) {
  Particles p = spheres({{5, 5, 5}, {7.05, 5, 5}});
  ContactList list;
  list.skin = 0.2;
  Cell cell = cube(10);
  rebuild(list, p, cell, cold, both, 1);
  EXPECT_EQ(list_age(list, p, cell, cold, 1), 0);
  p.body[1].position[1] += 0.05;
  EXPECT_NEAR(list_age(list, p, cell, cold, 1), 0.5, 1e-12);
  EXPECT_NEAR(list_age(list, p, cell, {1.01}, 1), 0.5 + 0.01 * 2 / 0.2, 1e-12);
  p.body[1].position[1] -= 0.05;
  const Mat3 f = Vec3(0.99, 1, 1).asDiagonal();
  cell.h = f * cell.h;
  for (auto& b : p.body) b.position = f * b.position;
  EXPECT_NEAR(list_age(list, p, cell, cold, 1), 0.01 * 2.2 / 0.2, 1e-12);
  p.body[0].position[2] = unset;
  EXPECT_TRUE(std::isnan(list_age(list, p, cell, cold, 1)));
}

}  // namespace
}  // namespace densify::dem
