// The rule of every stream: a word that is offered stays, unchanged, until it is taken.
logic began = 1'b0;
logic waited = 1'b0;
assign rst_n = began;
always_ff @(posedge clk) begin
    began  <= 1'b1;
    waited <= began && m_valid && !m_ready;
    before <= word;
    if (began && waited) assert (m_valid && before == word);
end
