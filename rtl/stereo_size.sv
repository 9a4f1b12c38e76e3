// Stereo: the size of the picture that an eye's model is drawn into, as the library's `stereo::Arrangement`.
//
//   arrangement 2, side by side      WIDTH / 2 by HEIGHT, the right eye what is left of the width
//   arrangement 4, top and bottom    WIDTH by HEIGHT / 2, the right eye what is left of the height
//   any other                        WIDTH by HEIGHT
//
// So when the side is odd, the right eye has the larger half; stereo_place says where the halves are shown. Whole pixels; no registers.
`default_nettype none

module stereo_size #(
    parameter int WIDTH  = 640,
    parameter int HEIGHT = 480,
    parameter int W_SIZE = 11
) (
    input  wire logic [       2:0] arrangement,
    input  wire logic              right,
    output logic      [W_SIZE-1:0] width,
    output logic      [W_SIZE-1:0] height
);
    localparam logic [W_SIZE-1:0] ALL_WIDTH = W_SIZE'(WIDTH);
    localparam logic [W_SIZE-1:0] HALF_WIDTH = W_SIZE'(WIDTH / 2);
    localparam logic [W_SIZE-1:0] ALL_HEIGHT = W_SIZE'(HEIGHT);
    localparam logic [W_SIZE-1:0] HALF_HEIGHT = W_SIZE'(HEIGHT / 2);

    always_comb begin
        width  = ALL_WIDTH;
        height = ALL_HEIGHT;
        if (arrangement == 3'd2) width = right ? ALL_WIDTH - HALF_WIDTH : HALF_WIDTH;
        if (arrangement == 3'd4) height = right ? ALL_HEIGHT - HALF_HEIGHT : HALF_HEIGHT;
    end
endmodule

`default_nettype wire
