// Scan-out: one pixel from the two eyes' pixels; see stereo_place for the arrangements.
//
//   code  anaglyph       red            green               blue
//     1   colour         red left       green right         blue right
//     5   grey           luma left      luma right          luma right
//     6   half colour    luma left      green right         blue right
//     7   Dubois         each: six levels, red left to blue right, times its row of DUBOIS
//
//   luma    = (19595 R + 38470 G + 7471 B) / 65536             rounded down; the weights sum to 65536, so it never exceeds 255
//   Dubois  = clamp(sum of six products / 65536, 0, 255)       weights Q1.16; sums lie between -2^22 and 2^25, so 27 bits
//
// As `scanout_head::stereo::mix`, to the last bit. Without registers.
//
// STEREO 1: codes 0 to 3, only wires and multiplexers. An anaglyph takes the left eye's red and the right eye's green and blue,
//   whatever the colours are; so `m_set`, whether something is drawn here, has a bit for each channel: red, green, blue from the
//   top, and what lies under the drawing may be put there later.
// STEREO 2: also codes 4 to 6, six products with constants; 7 is as 6. STEREO 3: also code 7, eighteen more. A weighted channel
//   sees both eyes, so what lies under the drawing (`s_under_rgb`) must be there before: `m_set` is all ones.
`default_nettype none

module stereo_mix #(
    parameter int STEREO     = 1,
    parameter int W_ARRANGED = STEREO > 1 ? 3 : 2
) (
    input  wire logic [W_ARRANGED-1:0] arrangement,
    input  wire logic                  s_right,
    input  wire logic                  s_left_set,
    input  wire logic [          23:0] s_left_rgb,
    input  wire logic                  s_right_set,
    input  wire logic [          23:0] s_right_rgb,
    input  wire logic [          23:0] s_under_rgb,
    output logic      [           2:0] m_set,
    output logic      [          23:0] m_rgb
);
    generate
        if (STEREO > 1) begin : g_weighted
            logic [23:0] left;
            logic [23:0] right;
            logic [ 7:0] left_luma;
            logic [ 7:0] right_luma;
            logic [23:0] dubois;

            assign left  = s_left_set ? s_left_rgb : s_under_rgb;
            assign right = s_right_set ? s_right_rgb : s_under_rgb;

            logic [23:0] left_sum;
            logic [23:0] right_sum;
            always_comb begin
                left_sum  = 24'd19595 * {16'd0, left[23:16]} + 24'd38470 * {16'd0, left[15:8]} + 24'd7471 * {16'd0, left[7:0]};
                right_sum = 24'd19595 * {16'd0, right[23:16]} + 24'd38470 * {16'd0, right[15:8]} + 24'd7471 * {16'd0, right[7:0]};
            end
            assign left_luma  = left_sum[23:16];
            assign right_luma = right_sum[23:16];

            if (STEREO > 2) begin : g_dubois
                // Rows red, green, blue; each red left to blue right, first at the top. Magnitudes, and which are subtracted: products and
                // sums stay unsigned until the last bit.
                localparam logic [18*17-1:0] DUBOIS = {
                    17'd29891, 17'd32800, 17'd11559, 17'd2849, 17'd5763, 17'd102,
                    17'd2627, 17'd2479, 17'd1033, 17'd24804, 17'd48080, 17'd1209,
                    17'd997, 17'd1350, 17'd358, 17'd4729, 17'd7403, 17'd80373
                };
                localparam logic [17:0] SUBTRACTED = 18'b000111_111001_111110;
                logic [47:0] levels;
                assign levels = {left, right};
                for (genvar c = 0; c < 3; c++) begin : g_channel
                    logic [26:0] sum;
                    always_comb begin
                        logic [26:0] product;
                        sum = '0;
                        for (int i = 0; i < 6; i++) begin
                            product = {10'd0, DUBOIS[17*(6*c+i)+:17]} * {19'd0, levels[8*i+:8]};
                            sum     = SUBTRACTED[6*c+i] ? sum - product : sum + product;
                        end
                    end
                    assign dubois[8*c+:8] = sum[26] ? 8'd0 : sum[25:24] != '0 ? 8'd255 : sum[23:16];
                    logic unused_fraction;
                    assign unused_fraction = &sum[15:0];
                end
            end else begin : g_without
                assign dubois = {left_luma, right[15:0]};
            end

            always_comb begin
                m_rgb = s_right ? right : left;
                case (arrangement)
                    3'd1:    m_rgb = {left[23:16], right[15:0]};
                    3'd5:    m_rgb = {left_luma, right_luma, right_luma};
                    3'd6:    m_rgb = {left_luma, right[15:0]};
                    3'd7:    m_rgb = dubois;
                    default: ;
                endcase
            end
            assign m_set = '1;
            logic unused_fractions;
            assign unused_fractions = &{left_sum[15:0], right_sum[15:0]};
        end else begin : g_channels
            always_comb begin
                m_rgb = s_right ? s_right_rgb : s_left_rgb;
                m_set = {3{s_right ? s_right_set : s_left_set}};
                if (arrangement == 2'd1) begin
                    m_rgb = {s_left_rgb[23:16], s_right_rgb[15:0]};
                    m_set = {s_left_set, s_right_set, s_right_set};
                end
            end
            logic unused_under;
            assign unused_under = ^s_under_rgb;
        end
    endgenerate
endmodule

`default_nettype wire
