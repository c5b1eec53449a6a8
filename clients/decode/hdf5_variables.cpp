#include "clients/decode/hdf5_variables.hpp"

#include "core/read/text_shape.hpp"

#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::decode {
namespace {

constexpr int kDeepest = 16;
constexpr std::size_t kMostObjects = 4096;
constexpr int kMostMembers = 256;

/// A handle of the library that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class Walk {
 public:
  Walk(VariableWriter& writer, std::size_t budget_bytes) : writer_(writer), budget_(budget_bytes) {}

  Status group(hid_t id, const std::string& path, int depth);

 private:
  void stated_rates(hid_t id, const std::string& path);
  Status dataset(hid_t id, const std::string& path);
  Status array(hid_t dataset, hid_t type, const std::vector<hsize_t>& shape, bool turned, const std::string& path);
  void left_out(const std::string& path, const std::string& why) {
    writer_.note("'" + std::string(text::front_of(path, 200)) + "' is left out: " + why + ".");
  }

  VariableWriter& writer_;
  std::size_t budget_;
  std::size_t objects_ = 0;
};

tl::unexpected<Error> damaged(const std::string& path) {
  return fail(ErrorCode::ShapeMismatch,
              "The HDF5 file is damaged at '" + std::string(text::front_of(path, 200)) + "'.");
}

/// Name of the link number `index`.
std::optional<std::string> link_name(hid_t group, hsize_t index) {
  const ssize_t size = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, nullptr, 0, H5P_DEFAULT);
  if (size < 0 || size > 1024) {
    return std::nullopt;
  }
  std::string name(static_cast<std::size_t>(size) + 1, '\0');
  H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, name.data(), name.size(), H5P_DEFAULT);
  name.resize(static_cast<std::size_t>(size));
  return name;
}

/// What `object` states of the rate of its samples, as arrays of one number under the names of the attributes.
void Walk::stated_rates(hid_t object, const std::string& path) {
  for (const char* const name : {"sampling_rate", "sample_rate", "samplerate", "rate_hz", "fs", "Fs"}) {
    if (H5Aexists(object, name) <= 0) {
      continue;
    }
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose);
    const Handle space(H5Aget_space(attribute.get()), H5Sclose);
    double value = 0.0;
    const H5T_class_t kind = H5Tget_class(type.get());
    if ((kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Sget_simple_extent_npoints(space.get()) == 1 &&
        H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0) {
      const std::vector<double> one{value};
      writer_.variable(path.empty() ? name : path + "." + name, std::span(&one, 1));
      return;
    }
  }
}

/// The name of the first filter of an array that the library does not have; nothing where it has all.
std::optional<std::string> unknown_filter(hid_t creation) {
  const int filters = std::max(H5Pget_nfilters(creation), 0);
  for (int i = 0; i < filters; ++i) {
    std::array<char, 64> name{};
    unsigned flags = 0;
    unsigned configuration = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                               name.size() - 1, name.data(), &configuration);
    if (filter < 0 || H5Zfilter_avail(filter) <= 0) {
      // By the HDF Group's list of registered filters; the name in the file is what its writer put there.
      constexpr std::array kRegistered{std::pair{32000, "lzf"}, std::pair{32001, "blosc"}, std::pair{32004, "lz4"},
                                       std::pair{32008, "bitshuffle"}, std::pair{32015, "zstd"}};
      const auto known = std::find_if(kRegistered.begin(), kRegistered.end(),
                                      [&](const auto& registered) { return registered.first == filter; });
      return known != kRegistered.end() ? known->second
             : name.front() != '\0'     ? std::string(name.data())
                                        : "number " + std::to_string(filter);
    }
  }
  return std::nullopt;
}

Status Walk::group(hid_t id, const std::string& path, int depth) {
  stated_rates(id, path);
  H5G_info_t info{};
  if (H5Gget_info(id, &info) < 0) {
    return damaged(path);
  }
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    if (++objects_ > kMostObjects) {
      writer_.note("The file holds more than " + std::to_string(kMostObjects) + " objects; the rest is left out.");
      return {};
    }
    const std::optional<std::string> name = link_name(id, i);
    H5L_info_t link{};
    if (!name || H5Lget_info_by_idx(id, ".", H5_INDEX_NAME, H5_ITER_INC, i, &link, H5P_DEFAULT) < 0) {
      return damaged(path);
    }
    if (name->starts_with("#")) {
      continue;  // MATLAB's own
    }
    const std::string full = path.empty() ? *name : path + "." + *name;
    if (link.type != H5L_TYPE_HARD) {
      left_out(full, "it is a link");
      continue;
    }
    const Handle object(H5Oopen(id, name->c_str(), H5P_DEFAULT), H5Oclose);
    if (!object.open()) {
      return damaged(full);
    }
    const H5I_type_t kind = H5Iget_type(object.get());
    if (kind == H5I_GROUP && depth >= kDeepest) {
      left_out(full, "it lies deeper than " + std::to_string(kDeepest) + " groups");
      continue;
    }
    const Status taken = kind == H5I_GROUP     ? group(object.get(), full, depth + 1)
                         : kind == H5I_DATASET ? dataset(object.get(), full)
                                               : Status{};
    if (!taken) {
      return taken;
    }
  }
  return {};
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  // h5py writes a truth value as an enumeration of FALSE and TRUE.
  return kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM;
}

Status Walk::dataset(hid_t id, const std::string& path) {
  const Handle type(H5Dget_type(id), H5Tclose);
  const Handle space(H5Dget_space(id), H5Sclose);
  const Handle creation(H5Dget_create_plist(id), H5Pclose);
  if (!type.open() || !space.open() || !creation.open()) {
    return damaged(path);
  }
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) {
    return damaged(path);
  }
  if (rank > 2) {
    left_out(path, "it has " + std::to_string(rank) + " dimensions");
    return {};
  }
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  if (layout == H5D_VIRTUAL || (layout == H5D_CONTIGUOUS && H5Pget_external_count(creation.get()) > 0)) {
    left_out(path, "its samples are in another file");
    return {};
  }
  if (const auto filter = unknown_filter(creation.get())) {
    left_out(path, "it is packed with the filter '" + *filter +
                       "', which is not read; write the file anew with h5repack -f GZIP=4");
    return {};
  }
  const std::size_t point = path.rfind('.');
  stated_rates(id, point == std::string::npos ? "" : path.substr(0, point));
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (rank > 0 && H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr) < 0) {
    return damaged(path);
  }
  const bool matlab = H5Aexists(id, "MATLAB_class") > 0;
  if (H5Tget_class(type.get()) == H5T_COMPOUND && rank == 1) {
    const int members = std::min(H5Tget_nmembers(type.get()), kMostMembers);
    for (int m = 0; m < members; ++m) {
      const Handle member(H5Tget_member_type(type.get(), static_cast<unsigned>(m)), H5Tclose);
      char* const name = H5Tget_member_name(type.get(), static_cast<unsigned>(m));
      const std::string own = name != nullptr ? name : "";
      H5free_memory(name);
      if (!member.open() || !is_number(member.get())) {
        continue;
      }
      const Handle wanted(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
      if (H5Tinsert(wanted.get(), own.c_str(), 0, H5T_NATIVE_DOUBLE) < 0) {
        return damaged(path);
      }
      std::string place = path;
      place.append(".").append(own);
      if (auto taken = array(id, wanted.get(), shape, false, place); !taken) {
        return taken;
      }
    }
    return {};
  }
  if (!is_number(type.get())) {
    left_out(path, "it holds no real numbers");
    return {};
  }
  return array(id, H5T_NATIVE_DOUBLE, shape, matlab, path);
}

Status Walk::array(hid_t dataset, hid_t type, const std::vector<hsize_t>& shape, bool turned, const std::string& path) {
  const hsize_t outer = shape.empty() ? 1 : shape[0];
  const hsize_t inner = shape.size() < 2 ? 1 : shape[1];
  const hsize_t most = budget_ / sizeof(double);
  if (outer == 0 || inner == 0) {
    return {};
  }
  if (outer > most / inner) {
    return fail(ErrorCode::LimitExceeded, "The arrays of the HDF5 file take more memory than one decoding may.");
  }
  const auto count = static_cast<std::size_t>(outer * inner);
  budget_ -= count * sizeof(double);
  std::vector<double> values(count);
  // An enumeration is no number to the library until it is read as the integer that it is.
  const Handle stored(H5Dget_type(dataset), H5Tclose);
  const bool enumerated = H5Tget_class(stored.get()) == H5T_ENUM;
  if (enumerated) {
    const Handle native(H5Tget_native_type(stored.get(), H5T_DIR_ASCEND), H5Tclose);
    std::vector<signed char> flags(count);
    if (H5Tget_size(native.get()) != 1 ||
        H5Dread(dataset, native.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, flags.data()) < 0) {
      left_out(path, "it holds no real numbers");
      return {};
    }
    values.assign(flags.begin(), flags.end());
  } else if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    return damaged(path);
  }
  // The inner index runs fastest: it counts the columns, in MATLAB's files the rows.
  const auto rows = static_cast<std::size_t>(turned && shape.size() == 2 ? inner : outer);
  const std::size_t columns = count / rows;
  if (columns > 1024 && rows > 1024) {
    left_out(path, "it is no table");
    return {};
  }
  std::vector<std::vector<double>> table(columns, std::vector<double>(rows));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      table[c][r] = values[turned && shape.size() == 2 ? c * rows + r : r * columns + c];
    }
  }
  if (columns > 4096) {  // samples across
    std::vector<std::vector<double>> upright(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      upright[r].reserve(columns);
      for (std::size_t c = 0; c < columns; ++c) {
        upright[r].push_back(table[c][r]);
      }
    }
    table = std::move(upright);
  }
  writer_.variable(path, table);
  return {};
}

}  // namespace

Status write_hdf5_variables(std::span<const std::byte> image, std::size_t budget_bytes, VariableWriter& writer) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);  // filters come with the library, never from the file's wishes
  void* const bytes = const_cast<std::byte*>(image.data());
  const Handle file(H5LTopen_file_image(bytes, image.size(), H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE),
                    H5Fclose);
  if (!file.open()) {
    return fail(ErrorCode::ShapeMismatch, "The HDF5 file is damaged: it does not open.");
  }
  const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  if (!root.open()) {
    return damaged("/");
  }
  return Walk(writer, budget_bytes).group(root.get(), "", 0);
}

}  // namespace driftlab::decode
