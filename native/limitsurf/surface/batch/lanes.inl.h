// SPDX-License-Identifier: Apache-2.0
//
// Arithmetic on several numbers at once. To be included inside a namespace that is compiled for one
// instruction set, as patch_kernels.cpp does.

/// kCount numbers on which one instruction works.
template <int kCount>
struct Lanes {
#if defined(__GNUC__)
  typedef double Numbers __attribute__((vector_size(kCount * sizeof(double))));
  Numbers numbers;

  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return {a.numbers + b.numbers};
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return {a.numbers - b.numbers};
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return {a.numbers * b.numbers};
  }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return {a.numbers / b.numbers};
  }
  [[gnu::always_inline]] static Lanes of(double a) { return {a - Numbers{}}; }
  [[gnu::always_inline]] static Lanes larger(const Lanes& a, const Lanes& b) {
    return {a.numbers > b.numbers ? a.numbers : b.numbers};
  }
  [[gnu::always_inline]] static Lanes smaller(const Lanes& a, const Lanes& b) {
    return {a.numbers < b.numbers ? a.numbers : b.numbers};
  }
  /// `a`, or `b` where `a` is 0.
  [[gnu::always_inline]] static Lanes unlessZero(const Lanes& a, const Lanes& b) {
    return {a.numbers == Numbers{} ? b.numbers : a.numbers};
  }
  /// `a` where x >= y, `b` elsewhere and where x or y is NaN.
  [[gnu::always_inline]] static Lanes whereAtLeast(const Lanes& x, const Lanes& y, const Lanes& a,
                                                   const Lanes& b) {
    return {x.numbers >= y.numbers ? a.numbers : b.numbers};
  }
#else
  double numbers[kCount];

  template <typename Operation>
  static Lanes each(const Lanes& a, const Lanes& b, const Operation& operation) {
    Lanes result;
    for (int i = 0; i < kCount; ++i) {
      result.numbers[i] = operation(a.numbers[i], b.numbers[i]);
    }
    return result;
  }
  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x + y; });
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x - y; });
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x * y; });
  }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x / y; });
  }
  [[gnu::always_inline]] static Lanes of(double a) {
    Lanes result;
    for (double& number : result.numbers) {
      number = a;
    }
    return result;
  }
  [[gnu::always_inline]] static Lanes larger(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x > y ? x : y; });
  }
  [[gnu::always_inline]] static Lanes smaller(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x < y ? x : y; });
  }
  [[gnu::always_inline]] static Lanes unlessZero(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x == 0 ? y : x; });
  }
  static Lanes whereAtLeast(const Lanes& x, const Lanes& y, const Lanes& a, const Lanes& b) {
    Lanes result;
    for (int i = 0; i < kCount; ++i) {
      result.numbers[i] = x.numbers[i] >= y.numbers[i] ? a.numbers[i] : b.numbers[i];
    }
    return result;
  }
#endif
  [[gnu::always_inline]] friend Lanes operator+(const Lanes& a, double b) { return a + of(b); }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& a, double b) { return a - of(b); }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& a, double b) { return a * of(b); }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& a, double b) { return a / of(b); }
  [[gnu::always_inline]] friend Lanes operator+(double a, const Lanes& b) { return of(a) + b; }
  [[gnu::always_inline]] friend Lanes operator-(double a, const Lanes& b) { return of(a) - b; }
  [[gnu::always_inline]] friend Lanes operator*(double a, const Lanes& b) { return of(a) * b; }

  [[gnu::always_inline]] static Lanes load(const double* from) {
    Lanes result;
    __builtin_memcpy(&result, from, sizeof result);
    return result;
  }
  [[gnu::always_inline]] void store(double* to) const { __builtin_memcpy(to, this, sizeof *this); }
  [[gnu::always_inline]] void store(float* to) const {
    double exact[kCount];
    store(exact);
    for (int i = 0; i < kCount; ++i) {
      to[i] = static_cast<float>(exact[i]);
    }
  }
};
