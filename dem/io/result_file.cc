#include "dem/io/result_file.h"

#include "base/check.h"
#include "dem/io/hdf5_file.h"

namespace densify::dem {

namespace {

constexpr const char* snapshot_group = "/snapshot";

void write_particles(Hdf5Writer& file, const std::string& group, const Snapshot& s) {
  file.list(group + "/id", s.id, "");
  file.list(group + "/material", s.material, "");
  file.table(group + "/position", s.position, "m");
  file.list(group + "/radius", s.radius, "m");
  file.table(group + "/velocity", s.velocity, "m/s");
  if (s.has_friction) file.table(group + "/angular_velocity", s.angular_velocity, "rad/s");
  std::vector<double> stress;
  for (const auto& tensor : s.stress) stress.insert(stress.end(), tensor.begin(), tensor.end());
  file.table(group + "/stress", stress, 6, "Pa");
  file.attribute(group + "/stress", "components", "xx yy zz yz xz xy");
  file.list(group + "/coordination", s.coordination, "");
  if (!s.local_density.empty()) file.list(group + "/local_density", s.local_density, "1");
}

void write_contacts(Hdf5Writer& file, const std::string& group, const Snapshot& s) {
  file.list(group + "/first_id", s.first_id, "");
  file.list(group + "/second_id", s.second_id, "");
  if (s.cell.periodic) file.list(group + "/image", s.image, "");
  file.list(group + "/overlap", s.overlap, "m");
  file.list(group + "/normal_force", s.normal_force, "N");
  if (s.has_friction) file.table(group + "/tangential_force", s.tangential_force, "N");
  if (!s.has_necks) return;
  file.list(group + "/sintering_force", s.sintering_force, "N");
  file.list(group + "/neck_radius", s.neck_radius, "m");
  file.list(group + "/elastic_displacement", s.elastic_displacement, "m");
  file.list(group + "/since", s.since, "s");
  file.list(group + "/phase", s.phase, "");
  file.attribute(group + "/phase", "values",
                 "0 loose, 1 activating, 2 sintering, 3 arriving, 4 bonded, 5 deactivating, 6 dormant, 7 reactivating");
  if (!s.flow_share.empty()) file.list(group + "/flow_share", s.flow_share, "1");
}

void write_walls(Hdf5Writer& file, const std::string& group, const Snapshot& s) {
  std::vector<std::string> name, shape;
  std::vector<Vec3> point, normal;
  std::vector<double> radius;
  for (const auto& w : s.wall) {
    name.push_back(w.name);
    shape.push_back(w.shape == WallShape::plane ? "plane" : "cylinder");
    point.push_back(w.point);
    normal.push_back(w.normal);
    radius.push_back(w.radius);
  }
  file.texts(group + "/name", name);
  file.texts(group + "/shape", shape);
  file.table(group + "/point", point, "m");
  file.table(group + "/normal", normal, "1");
  file.list(group + "/radius", radius, "m");
  file.table(group + "/force", s.wall_force, "N");
}

void write_wall_contacts(Hdf5Writer& file, const std::string& group, const Snapshot& s) {
  file.list(group + "/id", s.wall_contact_id, "");
  file.list(group + "/wall", s.wall_contact_wall, "");
  file.table(group + "/force", s.wall_contact_force, "N");
  file.table(group + "/arm", s.wall_contact_arm, "m");
}

void write_snapshot(Hdf5Writer& file, const std::string& group, const Snapshot& s) {
  file.group(group);
  file.attribute(group, "time", s.moment.time);
  file.attribute(group, "temperature", s.moment.temperature);
  file.attribute(group, "pressure", s.moment.pressure);
  file.attribute(group, "relative_density", s.moment.relative_density);
  file.attribute(group, "stage", s.moment.stage);
  file.texts(group + "/materials", s.materials);
  write_particles(file, group + "/particles", s);
  write_contacts(file, group + "/contacts", s);
  if (!s.wall.empty()) {
    write_walls(file, group + "/walls", s);
    write_wall_contacts(file, group + "/wall_contacts", s);
  }
  if (!s.cell.periodic) return;
  file.table(group + "/cell/edges", {s.cell.h.data(), 9}, 3, "m");  // columns of h: one edge vector a row
  file.list(group + "/cell/origin", std::vector<double>(s.cell.origin.data(), s.cell.origin.data() + 3), "m");
  file.table(group + "/cell/velocity_gradient", {Mat3(s.cell.velocity_gradient.transpose()).data(), 9}, 3, "1/s");
}

void write_common(Hdf5Writer& file, const RunDescription& run, const std::filesystem::path& folder, bool complete) {
  file.attribute("/", "densify_version", run.version);
  file.attribute("/", "git_revision", run.git_revision);
  file.attribute("/", "layout", std::uint64_t(1));
  file.attribute("/", "complete", std::uint64_t(complete));
  file.attribute("/", "time_unit", "s");
  file.attribute("/", "temperature_unit", "K");
  file.attribute("/", "pressure_unit", "Pa");
  file.text("/effective_input", run.effective_input);
  file.group("/history");
  file.group("/snapshots");
  if (!std::filesystem::exists(folder / "history.csv")) return;
  const History history = read_history(folder / "history.csv");
  for (std::size_t c = 0; c < history.columns.size(); ++c) {
    std::string unit;
    for (const auto& column : run.history_columns)
      if (column.name == history.columns[c]) unit = column.unit;
    file.list("/history/" + history.columns[c], history.values[c], unit);
  }
  file.texts("/history/stage", history.stage);
}

}  // namespace

ResultFile::ResultFile(std::filesystem::path folder, RunDescription description, std::uint64_t snapshots)
    : folder_(std::move(folder)), description_(std::move(description)), snapshots_(snapshots) {
  std::error_code failure;
  std::filesystem::create_directories(folder_ / "snapshots", failure);
  if (failure)
    throw FileError((folder_ / "snapshots").string() + ": cannot make this folder (" + failure.message() + ")");
  recover_snapshots();
  write_linked(false);
  for (std::uint64_t later = snapshots_; std::filesystem::remove(snapshot_path(later), failure); ++later) {
  }
}

std::filesystem::path ResultFile::snapshot_path(std::uint64_t snapshot) const {
  return folder_ / "snapshots" / (six_digits(snapshot) + ".h5");
}

// A run killed while it removed the snapshots' files has them in result.h5.
void ResultFile::recover_snapshots() const {
  for (std::uint64_t s = 0; s < snapshots_; ++s) {
    if (std::filesystem::exists(snapshot_path(s))) continue;
    const std::string inside = "/snapshots/" + six_digits(s);
    if (!std::filesystem::exists(path()))
      throw InputError(snapshot_path(s).string() + ": this snapshot is missing; start again without --resume");
    const Hdf5Reader gathered(path());
    if (!gathered.has_own(inside))
      throw InputError(snapshot_path(s).string() + ": this snapshot is missing; start again without --resume");
    Hdf5Writer file(snapshot_path(s));
    file.copy(gathered, inside, snapshot_group);
    file.commit(Durability::power_loss);
  }
}

void ResultFile::write_linked(bool complete) const {
  Hdf5Writer file(path());
  write_common(file, description_, folder_, complete);
  for (std::uint64_t s = 0; s < snapshots_; ++s)
    file.external_link("/snapshots/" + six_digits(s), "snapshots/" + six_digits(s) + ".h5", snapshot_group);
  file.commit(Durability::kill);
}

void ResultFile::add_snapshot(const Snapshot& snapshot) {
  Hdf5Writer file(snapshot_path(snapshots_));
  write_snapshot(file, snapshot_group, snapshot);
  file.commit(Durability::power_loss);
  ++snapshots_;
  write_linked(false);
}

void ResultFile::consolidate(std::uintmax_t largest) {
  std::uintmax_t size = 0;
  std::error_code missing;
  for (std::uint64_t s = 0; s < snapshots_; ++s)
    if (const auto bytes = std::filesystem::file_size(snapshot_path(s), missing); !missing) size += bytes;
  if (size > largest) return write_linked(true);
  Hdf5Writer file(path());
  write_common(file, description_, folder_, true);
  for (std::uint64_t s = 0; s < snapshots_; ++s)
    file.copy(Hdf5Reader(snapshot_path(s)), snapshot_group, "/snapshots/" + six_digits(s));
  file.commit(Durability::power_loss);
  std::error_code ignored;  // left-over files are only a waste of space
  std::filesystem::remove_all(folder_ / "snapshots", ignored);
}

}  // namespace densify::dem
