// Between records of particles in memory and vectors with one element a lane. Included inside kernels_body.hpp's
// namespace, after Vector, width.
//
// Pairs of neighbouring values are loaded into their lanes and then separated, which is faster than gathers value by
// value: three loads a particle instead of six, and two shuffles for every two values of all lanes.

typedef double Pair __attribute__((vector_size(16), may_alias));
typedef double LoosePair __attribute__((vector_size(16), aligned(8), may_alias));
typedef double Quad __attribute__((vector_size(32), may_alias));

inline Pair load_pair(const double* p) {
  return *reinterpret_cast<const LoosePair*>(p);
}

/// The pairs at `at` of every second particle, side by side. A pair joins the others as it is loaded, which compilers
/// do not find by themselves.
inline Vector pairs(const double* at, const std::uint16_t* numbers) {
#if QDEM_KERNEL_WIDTH == 8
  __m512d all = _mm512_castpd128_pd512(_mm_load_pd(at + numbers[0]));
  all = _mm512_mask_broadcast_f64x2(all, 0x0c, _mm_load_pd(at + numbers[2]));
  all = _mm512_mask_broadcast_f64x2(all, 0x30, _mm_load_pd(at + numbers[4]));
  return _mm512_mask_broadcast_f64x2(all, 0xc0, _mm_load_pd(at + numbers[6]));
#elif QDEM_KERNEL_WIDTH == 4
  const __m256d low = _mm256_castpd128_pd256(_mm_load_pd(at + numbers[0]));
  return _mm256_insertf128_pd(low, _mm_load_pd(at + numbers[2]), 1);
#else
  return *reinterpret_cast<const Pair*>(at + numbers[0]);
#endif
}

template <int... i>
inline Vector even_interleaved(Vector even, Vector odd, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(even, odd, (i % 2 == 0 ? i : width + i - 1)...);
}
template <int... i>
inline Vector odd_interleaved(Vector even, Vector odd, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(even, odd, (i % 2 == 0 ? i + 1 : width + i)...);
}

/// Values 2 piece and 2 piece + 1 of the particles `numbers` of the lanes.
inline void read_pair(const double* records, const std::uint16_t* numbers, int piece, Vector* values) {
  constexpr auto all = std::make_integer_sequence<int, width>();
  const Vector even = pairs(records + 2 * piece, numbers);
  const Vector odd = pairs(records + 2 * piece, numbers + 1);
  values[2 * piece] = even_interleaved(even, odd, all);
  values[2 * piece + 1] = odd_interleaved(even, odd, all);
}

template <int lane>
inline void add_lane(double* slots, const std::uint16_t* numbers, Vector xy, Vector z) {
  constexpr int pair = lane / 2 * 2;
  // Slots are half as long as records: a factor that goes into the address. Their fourth value is never read.
  *reinterpret_cast<Quad*>(reinterpret_cast<char*>(slots) + sizeof(double) / 2 * numbers[lane]) +=
      __builtin_shufflevector(xy, z, pair, pair + 1, width + lane, width + lane);
}

template <int... lane>
inline void add_lanes(double* slots, const std::uint16_t* numbers, const Vector force[3],
                      std::integer_sequence<int, lane...> all) {
  const Vector xy[2] = {even_interleaved(force[0], force[1], all), odd_interleaved(force[0], force[1], all)};
  (add_lane<lane>(slots, numbers, xy[lane % 2], force[2]), ...);
}
