#include "dem/io/stored_snapshot.h"

#include <algorithm>

#include "base/check.h"

namespace densify::dem {

namespace {

/// The datasets of a group, all with as many rows as the group's first.
class Rows {
 public:
  Rows(const Hdf5Reader& file, std::string group, const std::string& first)
      : file_(file), group_(std::move(group)), rows_(file.shape(group_ + "/" + first).rows) {}

  bool has(const std::string& name) const { return file_.has(group_ + "/" + name); }
  [[noreturn]] void refuse(const std::string& name, const std::string& why) const {
    throw FileError(file_.path().string() + ": " + group_ + "/" + name + ": " + why);
  }

  template <class T>
  std::vector<T> list(const std::string& name) const {
    auto values = file_.read<T>(group_ + "/" + name);
    if (values.size() != rows_) refuse(name, "another length than the lists beside it");
    return values;
  }

  std::vector<Vec3> vectors(const std::string& name) const {
    const auto values = numbers(name, 3);
    std::vector<Vec3> all;
    for (std::size_t r = 0; r < rows_; ++r) all.push_back(Eigen::Map<const Vec3>(&values[3 * r]));
    return all;
  }

  std::vector<Stress> stresses(const std::string& name) const {
    const auto values = numbers(name, 6);
    std::vector<Stress> all(rows_);
    for (std::size_t r = 0; r < rows_; ++r) std::copy_n(&values[6 * r], 6, all[r].begin());
    return all;
  }

 private:
  std::vector<double> numbers(const std::string& name, std::size_t columns) const {
    auto values = file_.read<double>(group_ + "/" + name);
    if (values.size() != columns * rows_) refuse(name, "another length than the lists beside it");
    return values;
  }

  const Hdf5Reader& file_;
  std::string group_;
  std::size_t rows_;
};

void read_cell(const Hdf5Reader& file, const std::string& group, Cell& cell) {
  if (!file.has(group + "/edges")) return;
  const auto h = file.read<double>(group + "/edges"), origin = file.read<double>(group + "/origin"),
             gradient = file.read<double>(group + "/velocity_gradient");
  if (h.size() != 9 || origin.size() != 3 || gradient.size() != 9)
    throw FileError(file.path().string() + ": " + group + ": not the numbers of a cell");
  cell.periodic = true;
  cell.h = Eigen::Map<const Mat3>(h.data());  // one edge vector a row there, a column here
  cell.origin = Eigen::Map<const Vec3>(origin.data());
  cell.velocity_gradient = Eigen::Map<const Mat3>(gradient.data()).transpose();
}

void read_particles(const Rows& rows, Snapshot& s) {
  s.id = rows.list<std::uint32_t>("id");
  for (const auto id : s.id)
    if (id >= s.id.size()) rows.refuse("id", "a number beyond the particles");
  s.material = rows.list<std::uint8_t>("material");
  for (const auto m : s.material)
    if (m >= s.materials.size()) rows.refuse("material", "a number without a material");
  s.position = rows.vectors("position");
  s.radius = rows.list<double>("radius");
  s.velocity = rows.vectors("velocity");
  s.has_friction = rows.has("angular_velocity");
  if (s.has_friction) s.angular_velocity = rows.vectors("angular_velocity");
  s.stress = rows.stresses("stress");
  s.coordination = rows.list<std::uint32_t>("coordination");
  if (rows.has("local_density")) s.local_density = rows.list<double>("local_density");
  if (rows.has("local_density")) s.local_density = rows.list<double>("local_density");
}

void read_contacts(const Rows& rows, Snapshot& s) {
  s.first_id = rows.list<std::uint32_t>("first_id");
  s.second_id = rows.list<std::uint32_t>("second_id");
  if (s.cell.periodic) s.image = rows.list<std::uint8_t>("image");
  s.overlap = rows.list<double>("overlap");
  s.normal_force = rows.list<double>("normal_force");
  if (s.has_friction) s.tangential_force = rows.vectors("tangential_force");
  const auto place = places_of_ids(s);
  auto known = [&](std::uint32_t id) { return id < place.size() && place[id] < s.id.size(); };
  for (std::size_t c = 0; c < s.first_id.size(); ++c) {
    if (!known(s.first_id[c]) || !known(s.second_id[c])) rows.refuse("first_id", "a contact of no particle");
    if (s.cell.periodic && s.image[c] >= 27) rows.refuse("image", "not a neighbouring image of the cell");
    const Vec3& start = s.position[place[s.first_id[c]]];
    Vec3 branch = s.position[place[s.second_id[c]]] - start;
    if (s.cell.periodic) branch += s.cell.shift(s.image[c]);
    s.start.push_back(start);
    s.branch.push_back(branch);
  }
  s.has_necks = rows.has("neck_radius");
  if (!s.has_necks) return;
  s.sintering_force = rows.list<double>("sintering_force");
  s.neck_radius = rows.list<double>("neck_radius");
  s.elastic_displacement = rows.list<double>("elastic_displacement");
  s.since = rows.list<double>("since");
  s.phase = rows.list<std::uint8_t>("phase");
  if (rows.has("flow_share")) s.flow_share = rows.list<double>("flow_share");
  for (const auto p : s.phase)
    if (p > std::uint8_t(NeckPhase::reactivating)) rows.refuse("phase", "a number without a phase");
  if (rows.has("flow_share")) s.flow_share = rows.list<double>("flow_share");
}

void read_walls(const Rows& rows, const Hdf5Reader& file, const std::string& group, Snapshot& s) {
  const auto name = file.texts(group + "/name"), shape = file.texts(group + "/shape");
  const auto point = rows.vectors("point"), normal = rows.vectors("normal");
  const auto radius = rows.list<double>("radius");
  if (name.size() != radius.size() || shape.size() != radius.size()) rows.refuse("name", "another length");
  for (std::size_t w = 0; w < name.size(); ++w)
    s.wall.push_back({name[w], shape[w] == "plane" ? WallShape::plane : WallShape::cylinder, point[w], normal[w],
                      radius[w], Vec3::Zero(), 0, 0});
  s.wall_force = rows.vectors("force");
}

void read_wall_contacts(const Rows& rows, Snapshot& s) {
  s.wall_contact_id = rows.list<std::uint32_t>("id");
  s.wall_contact_wall = rows.list<std::uint8_t>("wall");
  s.wall_contact_force = rows.vectors("force");
  s.wall_contact_arm = rows.vectors("arm");
  const auto place = places_of_ids(s);
  for (std::size_t c = 0; c < s.wall_contact_id.size(); ++c) {
    const std::uint32_t id = s.wall_contact_id[c];
    if (id >= place.size() || place[id] >= s.id.size()) rows.refuse("id", "a contact of no particle");
    if (s.wall_contact_wall[c] >= s.wall.size()) rows.refuse("wall", "a number without a wall");
  }
}

}  // namespace

Snapshot read_snapshot(const Hdf5Reader& file, const std::string& group) {
  Snapshot s;
  s.moment = {file.attribute<double>(group, "time"), file.attribute<double>(group, "temperature"),
              file.attribute<double>(group, "pressure"), file.attribute<double>(group, "relative_density"),
              file.attribute<std::string>(group, "stage")};
  s.materials = file.texts(group + "/materials");
  read_cell(file, group + "/cell", s.cell);
  read_particles(Rows(file, group + "/particles", "id"), s);
  read_contacts(Rows(file, group + "/contacts", "first_id"), s);
  const std::string walls = group + "/walls", wall_contacts = group + "/wall_contacts";
  if (!file.has(walls)) return s;
  if (!file.has(wall_contacts))
    throw InputError(file.path().string() +
                     ": its snapshots have no contacts with walls, which earlier versions did not write; run the "
                     "scene again");
  read_walls(Rows(file, walls, "radius"), file, walls, s);
  read_wall_contacts(Rows(file, wall_contacts, "id"), s);
  return s;
}

}  // namespace densify::dem
