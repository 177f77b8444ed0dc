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

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.numbers + b.numbers}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.numbers - b.numbers}; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return {a.numbers * b.numbers}; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return {a.numbers / b.numbers}; }
  static Lanes of(double a) { return {a - Numbers{}}; }
  static Lanes larger(const Lanes& a, const Lanes& b) {
    return {a.numbers > b.numbers ? a.numbers : b.numbers};
  }
  static Lanes smaller(const Lanes& a, const Lanes& b) {
    return {a.numbers < b.numbers ? a.numbers : b.numbers};
  }
  /// `a`, or `b` where `a` is 0.
  static Lanes unlessZero(const Lanes& a, const Lanes& b) {
    return {a.numbers == 0 ? b.numbers : a.numbers};
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
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x + y; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x - y; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x * y; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x / y; });
  }
  static Lanes of(double a) {
    Lanes result;
    for (double& number : result.numbers) {
      number = a;
    }
    return result;
  }
  static Lanes larger(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x > y ? x : y; });
  }
  static Lanes smaller(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x < y ? x : y; });
  }
  static Lanes unlessZero(const Lanes& a, const Lanes& b) {
    return each(a, b, [](double x, double y) { return x == 0 ? y : x; });
  }
#endif
  friend Lanes operator+(const Lanes& a, double b) { return a + of(b); }
  friend Lanes operator-(const Lanes& a, double b) { return a - of(b); }
  friend Lanes operator*(const Lanes& a, double b) { return a * of(b); }
  friend Lanes operator/(const Lanes& a, double b) { return a / of(b); }
  friend Lanes operator+(double a, const Lanes& b) { return of(a) + b; }
  friend Lanes operator-(double a, const Lanes& b) { return of(a) - b; }
  friend Lanes operator*(double a, const Lanes& b) { return of(a) * b; }

  static Lanes load(const double* from) {
    Lanes result;
    __builtin_memcpy(&result, from, sizeof result);
    return result;
  }
  void store(double* to) const { __builtin_memcpy(to, this, sizeof *this); }
  void store(float* to) const {
    double exact[kCount];
    store(exact);
    for (int i = 0; i < kCount; ++i) {
      to[i] = static_cast<float>(exact[i]);
    }
  }
};
