// Threads of sutures as bytes and back. What is taken is checked: it throws InputError for what no
// scene could have made.
#pragma once

#include <vector>

#include "loads/suture_thread.h"
#include "saving/bytes.h"

namespace robot_tissue {

void putSutures(const std::vector<SutureThread>& threads, ByteWriter& out);
// `node_count`: of the state's cells, with their ghosts.
std::vector<SutureThread> takeSutures(int node_count, ByteReader& in);

bool haveBites(const std::vector<SutureThread>& threads);
void putBites(const std::vector<SutureThread>& threads, ByteWriter& out);
void takeBites(std::vector<SutureThread>& threads, ByteReader& in);

}  // namespace robot_tissue
