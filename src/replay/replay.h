// replay SCENE.yaml IN.bag OUT.bag: the tissue follows the transforms of a bag as the node would
// have, and what the node would have told goes into another bag. Time is the bag's, nothing hangs
// on the machine: the same bytes on every run and number of threads.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace robot_tissue {

// Exit code 0: OUT.bag is whole; 2: a line on `err` says why it is not there. `is_stopped` is asked
// now and then; once true the replay ends so.
int replay(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
           const std::function<bool()>& is_stopped);

}  // namespace robot_tissue
