#include "src/io/column.h"

#include <algorithm>

namespace needlework::io {

using hdf5::check;
using hdf5::Handle;
using hdf5::Shape;

namespace {

Shape with_rows(hsize_t rows, const Shape& row) {
  Shape shape{rows};
  shape.insert(shape.end(), row.begin(), row.end());
  return shape;
}

}  // namespace

Handle Column::create(hid_t group, const std::string& name, hid_t type, const Shape& row,
                      hsize_t chunk_rows, const std::string& place) {
  const Shape now = with_rows(0, row);
  Shape most = with_rows(H5S_UNLIMITED, row);
  Shape chunk = with_rows(chunk_rows, row);
  // HDF5 allows neither an empty chunk nor a chunk larger than the greatest extent of the dataset,
  // also when a row is empty.
  std::replace(most.begin(), most.end(), hsize_t{0}, hsize_t{1});
  std::replace(chunk.begin(), chunk.end(), hsize_t{0}, hsize_t{1});

  const int rank = static_cast<int>(now.size());
  const Handle space(H5Screate_simple(rank, now.data(), most.data()), H5Sclose, place);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, place);
  check(H5Pset_chunk(layout.get(), rank, chunk.data()), place);
  return {
      H5Dcreate2(group, name.c_str(), type, space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
      H5Dclose, place};
}

Column::Column(hid_t parent, const std::string& path, const std::string& place)
    : place_(place),
      dataset_(hdf5::open_dataset(parent, path, place)),
      shape_(hdf5::shape_of(dataset_.get(), place)) {}

void Column::append_as(hid_t type, const void* values, hsize_t count) {
  if (count == 0) return;
  Shape start(shape_.size(), 0);
  start[0] = shape_[0];
  Shape block = shape_;
  block[0] = count;
  shape_[0] += count;
  check(H5Dset_extent(dataset_.get(), shape_.data()), place_);
  if (std::count(shape_.begin(), shape_.end(), hsize_t{0}) > 0) return;

  const Handle file_space(H5Dget_space(dataset_.get()), H5Sclose, place_);
  check(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                            nullptr),
        place_);
  const Handle memory_space(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr),
                            H5Sclose, place_);
  check(H5Dwrite(dataset_.get(), type, memory_space.get(), file_space.get(), H5P_DEFAULT, values),
        place_);
}

}  // namespace needlework::io
