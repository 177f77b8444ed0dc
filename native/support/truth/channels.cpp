// SPDX-License-Identifier: Apache-2.0
#include "support/truth/channels.h"

#include <map>
#include <numeric>

namespace limitsurf::test {

Channel cutChannel(const Cage& cage, int edges_per_cut, Random& random) {
  std::map<std::pair<int, int>, std::pair<int, int>> sides;  // directed edge -> its corners
  int count = 0;
  for (const std::vector<int>& face : cage.faces) {
    const int size = static_cast<int>(face.size());
    for (int i = 0; i < size; ++i) {
      const int j = (i + 1) % size;
      sides[{face[i], face[j]}] = {count + i, count + j};
    }
    count += size;
  }
  std::vector<int> leader(count);
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int corner) {
    while (leader[corner] != corner) corner = leader[corner];
    return corner;
  };
  for (const auto& [edge, corners] : sides) {
    const auto beyond = sides.find({edge.second, edge.first});
    if (edge.first > edge.second || beyond == sides.end() || random.below(edges_per_cut) == 0) {
      continue;
    }
    leader[find(corners.first)] = find(beyond->second.second);
    leader[find(corners.second)] = find(beyond->second.first);
  }
  Channel channel;
  std::map<int, int> numbers;
  for (int corner = 0; corner < count; ++corner) {
    const int next = static_cast<int>(numbers.size());
    channel.indices.push_back(numbers.emplace(find(corner), next).first->second);
  }
  channel.value_count = static_cast<int>(numbers.size());
  return channel;
}

Channel chartChannel(const Cage& cage, int charts, Random& random) {
  Channel channel;
  for (const std::vector<int>& face : cage.faces) {
    const int chart = random.below(charts);
    for (int vertex : face) channel.indices.push_back(vertex * charts + chart);
  }
  channel.value_count = cage.vertexCount() * charts;
  return channel;
}

Channel scatteredChannel(const Cage& cage, int choices, Random& random) {
  Channel channel;
  for (const std::vector<int>& face : cage.faces) {
    for (int vertex : face) {
      const int choice = random.below(3) == 0 ? random.below(choices) : 0;
      channel.indices.push_back(vertex * choices + choice);
    }
  }
  channel.value_count = cage.vertexCount() * choices;
  return channel;
}

Channel randomChannel(const Cage& cage, Random& random) {
  switch (random.below(6)) {
    case 0:
      return cutChannel(cage, 10, random);
    case 1:
      return cutChannel(cage, 2, random);
    case 2:
      return chartChannel(cage, 2, random);
    case 3:
      return chartChannel(cage, 4, random);
    case 4:
      return scatteredChannel(cage, 3, random);
    default: {
      Channel channel = cutChannel(cage, 3, random);
      channel.value_count = 5;
      for (std::int64_t& index : channel.indices) index %= channel.value_count;
      return channel;
    }
  }
}

DataRows randomRows(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed);
  DataRows result(rows, columns);
  for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] = random.uniform(-1, 1);
  return result;
}

}  // namespace limitsurf::test
