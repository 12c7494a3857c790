// Included in the namespace of each number type: needlework, and that of each instruction set.
// Functions are defined outside of the class because of the latter (see simd-inl.h).

template <class T>
struct Vec3 {
  T x{}, y{}, z{};
};

template <class T>
NEEDLEWORK_INLINE T component(const Vec3<T>& a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> operator*(const Vec3<T>& a, const std::type_identity_t<T>& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> operator*(const std::type_identity_t<T>& s, const Vec3<T>& a) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
NEEDLEWORK_INLINE Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) {
  return a = a + b;
}
template <class T>
NEEDLEWORK_INLINE Vec3<T>& operator-=(Vec3<T>& a, const Vec3<T>& b) {
  return a = a - b;
}
template <class T>
bool operator==(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// a + b s and a - b s.
template <class T>
NEEDLEWORK_INLINE Vec3<T> add_scaled(const Vec3<T>& a, const Vec3<T>& b, const T& s) {
  return a + b * s;
}
template <class T>
NEEDLEWORK_INLINE Vec3<T> subtract_scaled(const Vec3<T>& a, const Vec3<T>& b, const T& s) {
  return a - b * s;
}

template <class T>
NEEDLEWORK_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class T>
NEEDLEWORK_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
