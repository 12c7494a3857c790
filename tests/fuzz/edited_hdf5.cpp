#include "tests/fuzz/edited_hdf5.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "tests/fuzz/target.h"

// HDF5 keeps memory after some errors; what it keeps is not ours to free.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace needlework::fuzz {
namespace {

using io::hdf5::Handle;
using io::hdf5::Session;
using io::hdf5::Shape;

constexpr int most_edits = 12;

herr_t add_path(hid_t, const char* name, const H5O_info_t*, void* list) {
  static_cast<std::vector<std::string>*>(list)->push_back(std::string("/") + name);
  return 0;
}

double a_number(FuzzedDataProvider& data) {
  constexpr double odd[] = {0,      1,   -1,           2,    3,    0.5,   1e-300, 1e19, 1e300,
                            -1e308, 4e9, 2147483648.0, -2.5, 1e15, 1.5e9, 5e-324, 1e-6};
  switch (data.ConsumeIntegralInRange(0, 4)) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return std::numeric_limits<double>::infinity();
    case 2:
      return data.ConsumeIntegral<std::int8_t>();
    case 3:
      return data.ConsumeFloatingPoint<double>();
    default:
      return data.PickValueInArray(odd);
  }
}

// Types of the file. Only those of numbers and of texts of fixed length can be given values.
Handle a_type(FuzzedDataProvider& data) {
  const auto copy = [](hid_t type) { return Handle(H5Tcopy(type), H5Tclose, "type"); };
  const hid_t numbers[] = {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE,    H5T_STD_I8LE,
                           H5T_STD_U8LE,   H5T_STD_I16BE,  H5T_STD_I32LE,     H5T_STD_U32LE,
                           H5T_STD_I64LE,  H5T_STD_U64LE,  H5T_NATIVE_LDOUBLE};
  switch (data.ConsumeIntegralInRange(0, 9)) {
    case 0: {
      Handle text = copy(H5T_C_S1);
      H5Tset_size(text.get(), H5T_VARIABLE);
      return text;
    }
    case 1: {
      Handle text = copy(H5T_C_S1);
      H5Tset_size(text.get(), data.ConsumeIntegralInRange<std::size_t>(1, 40));
      return text;
    }
    case 2: {
      Handle compound(H5Tcreate(H5T_COMPOUND, 16), H5Tclose, "type");
      H5Tinsert(compound.get(), "r", 0, H5T_IEEE_F64LE);
      H5Tinsert(compound.get(), "i", 8, H5T_STD_I64LE);
      return compound;
    }
    case 3: {
      const hsize_t three = 3;
      return {H5Tarray_create2(H5T_IEEE_F64LE, 1, &three), H5Tclose, "type"};
    }
    case 4:
      return {H5Tvlen_create(H5T_IEEE_F64LE), H5Tclose, "type"};
    case 5:
      return copy(data.ConsumeBool() ? H5T_STD_REF_OBJ : H5T_STD_B64LE);
    default:
      return copy(data.PickValueInArray(numbers));
  }
}

Shape a_shape(FuzzedDataProvider& data) {
  constexpr hsize_t extents[] = {0, 1,   2,    3,       4,          5,          7,
                                 9, 100, 5000, 1000000, 1ull << 31, 1ull << 33, 1ull << 60};
  Shape shape(data.ConsumeIntegralInRange<std::size_t>(0, 5));
  for (hsize_t& extent : shape) extent = data.PickValueInArray(extents);
  return shape;
}

Handle space_of(const Shape& shape) {
  return {shape.empty() ? H5Screate(H5S_SCALAR)
                        : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
          H5Sclose, "space"};
}

double size_of(const Shape& shape) {
  double size = 1;
  for (const hsize_t extent : shape) size *= static_cast<double>(extent);
  return size;
}

// Contiguous, in chunks with or without compression, virtual, or in another file.
Handle a_layout(FuzzedDataProvider& data, const Shape& shape, hid_t space) {
  Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "layout");
  switch (data.ConsumeIntegralInRange(0, 6)) {
    case 0:
    case 1: {
      Shape chunk = shape;
      for (hsize_t& extent : chunk) extent = std::clamp<hsize_t>(extent, 1, 64);
      if (chunk.empty()) break;
      H5Pset_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
      if (data.ConsumeBool()) H5Pset_deflate(layout.get(), 9);
      if (data.ConsumeBool()) H5Pset_shuffle(layout.get());
      break;
    }
    case 2:
      H5Pset_virtual(layout.get(), space, "/dev/null", "/elsewhere", space);
      break;
    case 3:
      H5Pset_external(layout.get(), "/dev/zero", 0, H5F_UNLIMITED);
      break;
    default:
      break;
  }
  return layout;
}

void write_values(hid_t dataset, hid_t type, const Shape& shape, FuzzedDataProvider& data) {
  if (size_of(shape) > 4096) return;
  const auto count = static_cast<std::size_t>(size_of(shape));
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_FLOAT || kind == H5T_INTEGER) {
    std::vector<double> values(count, a_number(data));
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 12) && data.ConsumeBool(); ++i) {
      values[i] = a_number(data);
    }
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  } else if (kind == H5T_STRING && H5Tis_variable_str(type) == 0) {
    std::string bytes = data.ConsumeRandomLengthString(100);
    bytes.resize(count * H5Tget_size(type), '=');
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  } else if (kind == H5T_STRING) {
    const std::string text = data.ConsumeRandomLengthString(200);
    const std::vector<const char*> pointers(count, text.c_str());
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data());
  }
}

void put_dataset(hid_t file, const std::string& name, FuzzedDataProvider& data) {
  const Handle type = a_type(data);
  const Shape shape = a_shape(data);
  const Handle space = space_of(shape);
  const Handle layout = a_layout(data, shape, space.get());
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "links");
  H5Pset_create_intermediate_group(links.get(), 1);
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type.get(), space.get(), links.get(),
                                   layout.get(), H5P_DEFAULT);
  if (dataset < 0) return;
  // What is in other files must not be written.
  const bool own =
      H5Pget_layout(layout.get()) != H5D_VIRTUAL && H5Pget_external_count(layout.get()) == 0;
  if (own) write_values(dataset, type.get(), shape, data);
  H5Dclose(dataset);
}

// New values, or another number of rows, of a dataset that is there.
void change_dataset(hid_t file, const std::string& name, FuzzedDataProvider& data) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (dataset < 0) return;
  {
    const Handle type(H5Dget_type(dataset), H5Tclose, name);
    Shape shape = io::hdf5::shape_of(dataset, name);
    if (data.ConsumeBool() && !shape.empty()) {
      constexpr hsize_t most = 1ull << 40, rows[] = {0, 1, 2, 3, 5, 100, 1000000, most};
      hsize_t& changed = shape[data.ConsumeIntegralInRange<std::size_t>(0, shape.size() - 1)];
      // HDF5 would take a step for each chunk that it removes, also of those never written.
      const bool was_most = changed >= most;
      changed = data.PickValueInArray(rows);
      if (!was_most) H5Dset_extent(dataset, shape.data());
    } else {
      write_values(dataset, type.get(), shape, data);
    }
  }
  H5Dclose(dataset);
}

void put_attribute(hid_t file, const std::string& object, FuzzedDataProvider& data) {
  constexpr const char* names[] = {"description", "boundary", "offset", "version", "name", "unit"};
  const char* name = data.PickValueInArray(names);
  const Handle type = a_type(data);
  Shape shape = a_shape(data);
  if (size_of(shape) > 4096) shape.clear();
  const Handle space = space_of(shape);
  H5Adelete_by_name(file, object.c_str(), name, H5P_DEFAULT);
  const hid_t attribute = H5Acreate_by_name(file, object.c_str(), name, type.get(), space.get(),
                                            H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0) return;
  if (H5Tget_class(type.get()) == H5T_STRING && H5Tis_variable_str(type.get()) > 0) {
    const std::string text = data.ConsumeRandomLengthString(100);
    const std::vector<const char*> pointers(static_cast<std::size_t>(size_of(shape)) + 1,
                                            text.c_str());
    H5Awrite(attribute, type.get(), pointers.data());
  }
  H5Aclose(attribute);
}

// One edit; HDF5 refuses some of them.
void apply(hid_t file, const std::string& name, const std::string& target,
           FuzzedDataProvider& data) {
  enum class Action { change, attribute, replace, remove, group, soft, hard, external, kMaxValue };
  const auto action = data.ConsumeEnum<Action>();
  if (action == Action::change) return change_dataset(file, name, data);
  if (action == Action::attribute) return put_attribute(file, name, data);
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const char* const path = name.c_str();
  if (action == Action::replace) put_dataset(file, name, data);
  if (action == Action::soft) {
    H5Lcreate_soft(target.c_str(), file, path, H5P_DEFAULT, H5P_DEFAULT);
  }
  if (action == Action::hard) {
    H5Lcreate_hard(file, target.c_str(), file, path, H5P_DEFAULT, H5P_DEFAULT);
  }
  if (action == Action::external) {
    H5Lcreate_external("/dev/null", "/elsewhere", file, path, H5P_DEFAULT, H5P_DEFAULT);
  }
  if (action == Action::group) {
    H5Gclose(H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
}

}  // namespace

BaseFile::BaseFile(std::string path) : path_(std::move(path)) {
  const Session session;
  const Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path_);
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file.get(), H5_INDEX_NAME, H5_ITER_INC, add_path, &objects_, H5O_INFO_BASIC);
#else
  H5Ovisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, add_path, &objects_);
#endif
}

void BaseFile::edit(const std::string& path, FuzzedDataProvider& data) const {
  std::filesystem::copy_file(path_, path, std::filesystem::copy_options::overwrite_existing);
  const Session session;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, path);
  const auto an_object = [&] {
    return objects_[data.ConsumeIntegralInRange<std::size_t>(0, objects_.size() - 1)];
  };
  for (int edits = 0; edits < most_edits && data.remaining_bytes() > 0; ++edits) {
    std::string name = an_object();
    if (data.ConsumeIntegralInRange(0, 9) == 0) name += "/new";
    try {
      apply(file.get(), name, an_object(), data);
    } catch (const IoError&) {
      // HDF5 does not make such a type, shape or layout.
    }
  }
}

}  // namespace needlework::fuzz
