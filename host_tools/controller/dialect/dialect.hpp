// The Grbl dialect from the sender's side: lines to send (program_lines.hpp), answers of the
// controller (answer.hpp), flow control that counts characters (flow_window.hpp).
//
//     ProgramLines program{"part.ngc"};
//     FlowWindow window;
//     while (const std::optional<ProgramLine> line = program.next()) {
//         const std::size_t size = line->text.size() + 1;
//         while (!window.fits(size)) {
//             const Answer answer = parse_answer(receive_line());
//             if (answer.kind == AnswerKind::kOk) {
//                 window.answered();
//             }
//         }
//         window.sent(line->number, size);
//         send(line->text + '\n');
//     }
#pragma once

#include "host_tools/controller/dialect/answer.hpp"
#include "host_tools/controller/dialect/flow_window.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
