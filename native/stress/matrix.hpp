// Small dense matrices of run-time size, with the functions needed to advance a linear system exactly.
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace riffler::stress {

class Matrix {
 public:
  Matrix() = default;
  Matrix(int rows, int columns) : rows_(rows), columns_(columns), a_(static_cast<std::size_t>(rows * columns), 0.0) {}
  static Matrix diagonal(const std::vector<double>& d) {
    Matrix m(static_cast<int>(d.size()), static_cast<int>(d.size()));
    for (int k = 0; k < m.rows_; ++k) m(k, k) = d[static_cast<std::size_t>(k)];
    return m;
  }
  static Matrix identity(int n) { return diagonal(std::vector<double>(static_cast<std::size_t>(n), 1.0)); }

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  double operator()(int i, int j) const { return a_[static_cast<std::size_t>(i * columns_ + j)]; }
  double& operator()(int i, int j) { return a_[static_cast<std::size_t>(i * columns_ + j)]; }

  friend Matrix operator*(double s, Matrix m) {
    for (double& x : m.a_) x *= s;
    return m;
  }
  friend Matrix operator+(Matrix a, const Matrix& b) {
    for (std::size_t k = 0; k < a.a_.size(); ++k) a.a_[k] += b.a_[k];
    return a;
  }
  friend Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix c(a.rows_, b.columns_);
    for (int i = 0; i < a.rows_; ++i)
      for (int k = 0; k < a.columns_; ++k)
        for (int j = 0; j < b.columns_; ++j) c(i, j) += a(i, k) * b(k, j);
    return c;
  }
  friend std::vector<double> operator*(const Matrix& a, const std::vector<double>& x) {
    std::vector<double> y(static_cast<std::size_t>(a.rows_), 0.0);
    for (int i = 0; i < a.rows_; ++i)
      for (int j = 0; j < a.columns_; ++j) y[static_cast<std::size_t>(i)] += a(i, j) * x[static_cast<std::size_t>(j)];
    return y;
  }

  double largest() const {
    double m = 0;
    for (const double x : a_) m = std::max(m, std::abs(x));
    return m;
  }

 private:
  int rows_ = 0, columns_ = 0;
  std::vector<double> a_;
};

inline Matrix transposed(const Matrix& m) {
  Matrix t(m.columns(), m.rows());
  for (int i = 0; i < m.rows(); ++i)
    for (int j = 0; j < m.columns(); ++j) t(j, i) = m(i, j);
  return t;
}

/// Gauss-Jordan elimination with row pivots.
inline Matrix inverse(Matrix a) {
  const int n = a.rows();
  Matrix b = Matrix::identity(n);
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int i = c + 1; i < n; ++i)
      if (std::abs(a(i, c)) > std::abs(a(pivot, c))) pivot = i;
    if (a(pivot, c) == 0) throw std::invalid_argument("inverse: the matrix is singular");
    for (int j = 0; j < n; ++j) std::swap(a(c, j), a(pivot, j)), std::swap(b(c, j), b(pivot, j));
    const double scale = 1 / a(c, c);
    for (int j = 0; j < n; ++j) a(c, j) *= scale, b(c, j) *= scale;
    for (int i = 0; i < n; ++i) {
      const double f = a(i, c);
      if (i == c || f == 0) continue;
      for (int j = 0; j < n; ++j) a(i, j) -= f * a(c, j), b(i, j) -= f * b(c, j);
    }
  }
  return b;
}

/// e^a, by scaling and squaring with a Taylor series.
inline Matrix exponential(const Matrix& a) {
  int squarings = 0;
  double size = a.largest() * a.rows();
  for (; size > 0.125; size /= 2) ++squarings;
  const Matrix part = std::ldexp(1.0, -squarings) * a;
  Matrix term = Matrix::identity(a.rows()), sum = term;
  for (int k = 1; k <= 14; ++k) term = (1.0 / k) * (term * part), sum = sum + term;
  for (int k = 0; k < squarings; ++k) sum = sum * sum;
  return sum;
}

inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace riffler::stress
